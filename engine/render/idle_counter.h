// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace shutter::render {

/// Frames for which memory is kept that nobody wants: a pause costs nothing then, and a scene that
/// has no more use for it gives it back.
inline constexpr uint32_t kFramesKept = 120;

/// Counts the frames in a row in which something was not wanted.
class IdleCounter {
  public:
    /// To be called each frame. \return true once, in the kFramesKept-th frame without a wish
    bool advance(bool wanted) {
        if (wanted)
            mIdle = 0;
        else if (mIdle <= kFramesKept)
            ++mIdle;
        return mIdle == kFramesKept;
    }

  private:
    uint32_t mIdle = 0;
};

} // namespace shutter::render
