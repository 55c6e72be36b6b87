// SPDX-License-Identifier: MIT
#include "modules/motion_blur/presets.h"

#include "modules/motion_blur/methods.h"

#include <string>
#include <vector>

namespace shutter::motion_blur {

namespace {

MotionBlurSettings makeFor(std::string_view method, uint32_t samples) {
    MotionBlurSettings settings;
    settings.method = &getMethod(method);
    settings.sampleCount = samples;
    return settings;
}

} // namespace

std::span<const Preset> listPresets() {
    static const std::vector<Preset> kPresets = {
        {"off", "no motion blur: the raster image", true, {}},
        {"performance", "fewer instants", false, makeFor("resolved", 9)},
        {"balanced", "no rays", false, makeFor("resolved", 15)},
        {"quality", "rays where the raster images do not suffice", false, makeFor("adaptive", 15)},
        {"paper", "with the numbers of the publication", false, paperSettings()},
    };
    return kPresets;
}

core::Result<const Preset*> findPreset(std::string_view name) {
    std::string names;
    for (const Preset& preset : listPresets()) {
        if (name == preset.name)
            return &preset;
        names += std::string(names.empty() ? "" : ", ") + preset.name;
    }
    return core::makeError("'{}' is unknown; there are {}", name, names);
}

} // namespace shutter::motion_blur
