// SPDX-License-Identifier: MIT
// README.md, "Presets", says what each costs.
#include "engine/core/setting_row.h"
#include "game/play/panel/play_settings.h"
#include "modules/motion_blur/settings.h"

namespace shutter::game {

namespace {

using motion_blur::MotionBlurSettings;

MotionBlurSettings makePerformance() {
    MotionBlurSettings blur;
    blur.sampleCount = 9;
    blur.rayShare = 0.25f;
    blur.uniformMotionPx = 1.0f;
    blur.halfResolutionPx = 8.0f;
    blur.foregroundMagnification = 1.0f;
    return blur;
}

/// The paper's settings without the magnification of the foreground: pictures are closer to the
/// truth that way.
MotionBlurSettings makeBalanced() {
    MotionBlurSettings blur;
    blur.foregroundMagnification = 1.0f;
    blur.rayShare = 0.5f;
    return blur;
}

MotionBlurSettings makeQuality() {
    MotionBlurSettings blur;
    blur.sampleCount = 31;
    blur.uniformMotionPx = 0.25f;
    blur.foregroundMagnification = 1.0f;
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

MotionBlurSettings makePlayBlur() {
    return makeBalanced();
}

std::span<const Preset> listPresets() {
    static const std::vector<Preset> kPresets = {
        {"off", "no motion blur: the raster image", "sharp", {}},
        {"performance",
         "few samples, a quarter of the rays, half of the resolution along long motion",
         "hybrid",
         makePerformance()},
        {"balanced", "samples of the paper, half of the rays", "hybrid", makeBalanced()},
        {"quality", "twice the samples, all rays", "hybrid", makeQuality()},
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
