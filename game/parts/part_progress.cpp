// SPDX-License-Identifier: MIT
#include "game/parts/part_progress.h"

namespace shutter::parts {

PartProgress::PartProgress(const PartWork& work)
    : mWork(work), mDone(work.countDone()), mBar(work.verb, work.stepCount - mDone) {}

void PartProgress::look() {
    const uint64_t done = mWork.countDone();
    if (done > mDone) {
        mBar.advance(done - mDone);
        mDone = done;
    }
}

} // namespace shutter::parts
