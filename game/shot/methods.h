// SPDX-License-Identifier: MIT
// The methods of drawing a picture, by name: those of the motion blur, and those that draw the
// scene in their own way.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "modules/motion_blur/methods.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

using motion_blur::RayNeed;
using motion_blur::SampleUnit;

/// The effect that a method is made of.
enum class MethodFamily : uint8_t { Sharp, MotionBlur, Accumulate, Truth };

struct MethodInfo {
    const char* name;
    const char* description;
    const char* publication; ///< authors and year; empty: nobody's in particular
    MethodFamily family;
    const motion_blur::Method* blur = nullptr; ///< of MethodFamily::MotionBlur; else null
    RayNeed rays = RayNeed::None;
    /// What `--samples` counts, which trades time for error; nothing: the method takes none.
    std::optional<SampleUnit> sampleUnit{};
    uint32_t defaultSamples = 0;     ///< 0 without a sample unit
    std::vector<std::string> aovs{}; ///< intermediates that it writes beyond the G-buffer's
};

[[nodiscard]] bool canRun(const MethodInfo& method, const gpu::Device& device);

/// In the order in which quality rises.
[[nodiscard]] std::span<const MethodInfo> listMethods();

/// Error: the names there are.
[[nodiscard]] core::Result<const MethodInfo*> findMethod(std::string_view name);

} // namespace shutter::game
