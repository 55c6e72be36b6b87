// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/frame.h"

#include <cstdint>

namespace shutter::app {

/// Where an overlay draws: a colour attachment of dynamic rendering that has begun, with viewport
/// and scissor set to all of it. Values are display-encoded.
struct OverlayTarget {
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t width = 0;  ///< pixels
    uint32_t height = 0; ///< pixels
    uint32_t slot = 0;   ///< of the frames in flight, below gpu::kMaxFramesInFlight
};

/// What is drawn over the picture on the window: the user interface.
class Overlay {
  public:
    virtual ~Overlay() = default;

    /// Records; called once a frame. The GPU is done with the slot's last frame.
    virtual void record(gpu::Frame& frame, const OverlayTarget& target) = 0;
};

} // namespace shutter::app
