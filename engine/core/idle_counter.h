// SPDX-License-Identifier: MIT
// Decides when resources that are no longer used are freed.
#pragma once

#include <cstdint>

namespace shutter::core {

/// Frames after which unused memory is freed: a short pause causes no reallocation, and a scene
/// that no longer needs the memory frees it.
inline constexpr uint32_t kFramesKept = 120;

/// Counts consecutive frames in which something was not wanted.
class IdleCounter {
  public:
    /// Must be called each frame. \return true once: in the kFramesKept-th frame in a row in which
    /// it was not wanted
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

} // namespace shutter::core
