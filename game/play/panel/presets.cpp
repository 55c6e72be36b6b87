// SPDX-License-Identifier: MIT
// README.md, "Presets", says what each costs.
#include "engine/core/setting_row.h"
#include "game/play/panel/play_settings.h"
#include "modules/motion_blur/settings.h"

namespace shutter::game {

namespace {

using motion_blur::MotionBlurSettings;

MotionBlurSettings makePerformance() {
    MotionBlurSettings blur = makePlayBlur();
    blur.sampleCount = 9;
    return blur;
}

/// What the authors' implementation does: every moving block takes the full path, and rays go from
/// hit to hit until the luminance differs.
MotionBlurSettings makePaper() {
    MotionBlurSettings blur;
    blur.uniformMotionPx = 0.0f;
    blur.objectTest = motion_blur::ObjectTest::Luminance;
    blur.revealTraversal = motion_blur::RevealTraversal::Stepping;
    return blur;
}

bool isSharp(const Preset& preset) {
    return std::string_view(preset.method) == "sharp";
}

} // namespace

/// Of the paper's methods, where a player chooses one: without the magnification of the foreground
/// pictures are closer to the truth, and half of the rays are enough.
MotionBlurSettings makePlayBlur() {
    MotionBlurSettings blur;
    blur.foregroundMagnification = 1.0f;
    blur.rayShare = 0.5f;
    return blur;
}

std::span<const Preset> listPresets() {
    static const std::vector<Preset> kPresets = {
        {"off", "no motion blur: the raster image", "sharp", {}},
        {"performance", "fewer instants", "resolved", makePerformance()},
        {"balanced", "no rays", "resolved", makePlayBlur()},
        {"quality", "rays where the raster images do not suffice", "adaptive", makePlayBlur()},
        {"paper", "as the paper's authors have it, without our shortcuts", "hybrid", makePaper()},
    };
    return kPresets;
}

void applyPreset(const Preset& preset, PlaySettings& settings) {
    settings.method = preset.method;
    if (!isSharp(preset))
        settings.blur = preset.blur;
}

bool isApplied(const Preset& preset, const PlaySettings& settings) {
    return settings.method == preset.method &&
           (isSharp(preset) || areEqual(motion_blur::listSettingRows(), settings.blur, preset.blur)
           );
}

} // namespace shutter::game
