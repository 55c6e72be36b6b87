// SPDX-License-Identifier: MIT
#include "modules/motion_blur/presets.h"

#include "modules/motion_blur/methods.h"

#include <string>
#include <vector>

namespace shutter::motion_blur {

namespace {

MotionBlurSettings makeFor(std::string_view method, uint32_t samples = 0) {
    MotionBlurSettings settings;
    settings.method = &getMethod(method);
    settings.sampleCount = samples;
    return settings;
}

/// What `balanced` shows in less time: where the motion of blocks differs by up to two pixels they
/// are still taken for one plane's, which no shot that was measured shows.
MotionBlurSettings makePerformance() {
    MotionBlurSettings settings = makeFor("resolved", 6);
    settings.uniformMotionPx = 2.0f;
    return settings;
}

} // namespace

std::span<const Preset> listPresets() {
    static const std::vector<Preset> kPresets = {
        {"off", "no motion blur: the raster image", true, {}},
        {"performance", "fewer instants, and more of the fast path", false, makePerformance()},
        {"balanced", "no rays", false, makeFor("resolved")},
        {"quality", "rays where the raster images do not suffice", false, makeFor("adaptive")},
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
