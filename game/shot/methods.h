// SPDX-License-Identifier: MIT
// The methods of drawing a picture, by name: those of the motion blur, and those that draw the
// scene differently; presets of them; and which of a picture's passes count as the method's.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/render/frame_statistics.h"
#include "modules/depth_of_field/filters.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/settings.h"

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
    const char* publication; ///< authors and year; empty: no particular one
    MethodFamily family;
    const motion_blur::Method* blur = nullptr; ///< null unless the family is MotionBlur
    RayNeed rays = RayNeed::None;
    bool hasLens = false; ///< it draws with the camera's lens; false: with a pinhole
    /// Depth-of-field filter for the pinhole's picture; null: none, or the method has a lens.
    const depth_of_field::Filter* lensFilter = nullptr;
    bool filtersBlurred = false; ///< the filter gets the blurred picture; false: the sharp one
    /// What `--samples` counts, which trades time for error; empty: the method takes no samples.
    std::optional<SampleUnit> sampleUnit{};
    uint32_t defaultSamples = 0;     ///< 0 without a sample unit
    std::vector<std::string> aovs{}; ///< intermediates that it writes beyond the G-buffer's
};

[[nodiscard]] bool canRun(const MethodInfo& method, const gpu::Device& device);
/// The first of the devices that can run it; null: none.
[[nodiscard]] const gpu::DeviceInfo*
findDeviceFor(const MethodInfo& method, std::span<const gpu::DeviceInfo> devices);

/// All methods, in order of rising quality.
[[nodiscard]] std::span<const MethodInfo> listMethods();

/// Error: lists the names of all methods.
[[nodiscard]] core::Result<const MethodInfo*> findMethod(std::string_view name);

/// "resolved, adaptive, denoised, accumulate or truth": the methods that have a lens.
/// \param before the last one: "or" or "and"
[[nodiscard]] std::string listLensMethods(std::string_view before);

/// A choice of a method and of the blur's settings by one word, for people who want no more.
struct Preset {
    const char* name;                     ///< "off", "performance", "balanced", "quality", "paper"
    const char* description;              ///< one line
    const char* method;                   ///< of listMethods()
    motion_blur::MotionBlurSettings blur; ///< unused where the method is sharp; its method too
};

/// In order of rising quality; the paper's comes last. game/play/README.md gives their costs.
[[nodiscard]] std::span<const Preset> listPresets();

/// Error: lists the names of all presets.
[[nodiscard]] core::Result<const Preset*> findPreset(std::string_view name);

enum class PassGroup : uint8_t {
    Scene,   ///< also drawn in a picture without blur
    Blur,    ///< added by the method, including acceleration structures for its rays
    Other,   ///< other effects: bloom, anti-aliasing, and acceleration structures for rays
    Display, ///< what brings the linear picture to the window or to memory
};

/// `sharp` adds nothing to a picture unless a lens filters it. The scene counts as the method's own
/// if it draws that differently (many frames, rays alone); rays do if it traces any.
[[nodiscard]] PassGroup groupOf(const MethodInfo& method, render::PassOwner owner);

/// GPU milliseconds of the passes of PassGroup::Blur.
[[nodiscard]] double
sumBlurMilliseconds(const MethodInfo& method, const render::FrameStatistics& statistics);

/// GPU milliseconds from the G-buffer to the linear picture.
[[nodiscard]] double sumFrameMilliseconds(const render::FrameStatistics& statistics);

} // namespace shutter::game
