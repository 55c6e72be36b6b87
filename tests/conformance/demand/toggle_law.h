// SPDX-License-Identifier: MIT
// What is switched on and off every frame leaves nothing behind: no bit in a picture, no memory.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "tests/conformance/stability/measured.h"

#include <cstdint>

namespace shutter::demand {

struct ToggleOptions {
    uint32_t frames = 2000; ///< a multiple of kToggleCycle, at least two of them
    uint32_t width = 48;
    uint32_t height = 32;
};

/// Frames after which the same switches are set again; memory is compared between ends of cycles.
inline constexpr uint32_t kToggleCycle = 200;

/// Draws frames with one renderer, each by another method than the one before, with and without
/// exposure, tone map and intermediates. Each is compared bit by bit with the same frame of a
/// renderer that has drawn nothing else; what exists on the device and what the process holds is
/// compared after the first cycle and after the last.
[[nodiscard]] core::Result<stability::Measurements>
measureToggles(gpu::Device& device, const ToggleOptions& options = {});

} // namespace shutter::demand
