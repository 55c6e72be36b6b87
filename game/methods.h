// SPDX-License-Identifier: MIT
// The methods there are, by name.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "modules/motion_blur/settings.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

/// The effect that a method is made of.
enum class MethodFamily : uint8_t { Sharp, MotionBlur, Accumulate, Truth };

/// What `--samples` counts; the number that trades time for error.
enum class Dial : uint8_t {
    None,
    Samples,  ///< taps of each gather
    Instants, ///< sharp frames
    Rays,     ///< rays a pixel
};

/// What a method asks of the device's ray tiers.
enum class RayNeed : uint8_t {
    None,
    Any,   ///< any tier that traces rays
    Query, ///< ray queries, which alone can be nested
};

struct MethodInfo {
    const char* name;
    const char* description;
    const char* publication; ///< authors and year; empty where it is nobody's in particular
    MethodFamily family;
    motion_blur::Method blur; ///< of MethodFamily::MotionBlur; else unused
    RayNeed rays;
    Dial dial;
    uint32_t defaultSamples;       ///< 0 with Dial::None
    std::vector<std::string> aovs; ///< intermediates it writes beyond the G-buffer's
};

[[nodiscard]] bool canRun(const MethodInfo& method, const gpu::Device& device);

/// In the order in which quality rises.
[[nodiscard]] std::span<const MethodInfo> listMethods();

/// Error: the names there are.
[[nodiscard]] core::Result<const MethodInfo*> findMethod(std::string_view name);

} // namespace shutter::game
