// SPDX-License-Identifier: MIT
#include "game/shot/presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace shutter::game {

namespace {

motion_blur::MotionBlurSettings makePerformance() {
    motion_blur::MotionBlurSettings blur;
    blur.sampleCount = 9;
    return blur;
}

} // namespace

std::span<const Preset> listPresets() {
    static const std::vector<Preset> kPresets = {
        {"off", "no motion blur: the raster image", "sharp", {}},
        {"performance", "fewer instants", "resolved", makePerformance()},
        {"balanced", "no rays", "resolved", {}},
        {"quality", "rays where the raster images do not suffice", "adaptive", {}},
        {"paper", "with the numbers of the publication", "hybrid", motion_blur::paperSettings()},
    };
    return kPresets;
}

core::Result<const Preset*> findPreset(std::string_view name) {
    std::vector<std::string_view> names;
    for (const Preset& preset : listPresets()) {
        if (name == preset.name)
            return &preset;
        names.emplace_back(preset.name);
    }
    return core::makeError("--preset '{}' is unknown; there are {}", name, fmt::join(names, ", "));
}

} // namespace shutter::game
