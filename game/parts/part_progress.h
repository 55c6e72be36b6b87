// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/progress.h"
#include "game/parts/part_work.h"

#include <cstdint>

namespace shutter::parts {

/// A bar over the steps of all parts that were missing when it was made.
class PartProgress {
  public:
    /// \param work outlives this
    explicit PartProgress(const PartWork& work);

    /// Looks at what is done and advances the bar.
    void look();

  private:
    const PartWork& mWork;
    uint64_t mDone;
    core::Progress mBar;
};

} // namespace shutter::parts
