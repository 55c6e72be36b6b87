// SPDX-License-Identifier: MIT
#include "game/shot/picture_settings.h"

#include <algorithm>
#include <array>

namespace shutter::game {

const PresetEffects* findPresetEffects(std::string_view preset) {
    using shadows::ShadowMode;
    static constexpr std::array kEffects = {
        PresetEffects{"performance", AntiAliasing::None, ShadowMode::Blurred, 0.0f, false},
        PresetEffects{"balanced", AntiAliasing::Taa, ShadowMode::Blurred, 0.04f, true},
        PresetEffects{"quality", AntiAliasing::Taa, ShadowMode::Blurred, 0.04f, true},
    };
    const auto found =
        std::find_if(kEffects.begin(), kEffects.end(), [&](const PresetEffects& effects) {
            return effects.preset == preset;
        });
    return found == kEffects.end() ? nullptr : &*found;
}

bool areEqual(const FeatureSettings& a, const FeatureSettings& b) {
    bool equal = true;
    visitFeatureRows([&](auto rows, const auto& part) {
        equal = equal && core::areEqual(rows, part(a), part(b));
    });
    return equal;
}

bool unseenMatters(const FeatureSettings& settings) {
    return settings.shadows.mode != shadows::ShadowMode::None;
}

core::SettingRows<PictureSettings> listPictureRows() {
    using S = PictureSettings;
    static constexpr std::string_view kAntiAliasings[] = {"none", "taa", "box"};
    static constexpr std::string_view kFits[] = {"whole", "height"};
    static const std::array<core::SettingRow<S>, 2> kRows = {{
        {"frameFit",
         core::makeWordField<&S::frameFit>(kFits),
         "",
         {},
         "A camera's frame in a picture of another shape: whole, or as high as the picture, whose "
         "sides then crop it where it is narrower.",
         "Camera's frame",
         "--frame-fit"},
        {"antiAliasing",
         core::makeWordField<&S::antiAliasing>(kAntiAliasings),
         "",
         {},
         "Smooth edges: taa by the frames before, box by the mean of 16 frames, which takes 16 "
         "times as long.",
         "Smooth edges",
         "--aa"},
    }};
    return kRows;
}

core::Status validate(const PictureSettings& settings) {
    core::Status status;
    visitPictureRows([&](auto rows, const auto& part) {
        if (status)
            status = core::validateRows(rows, part(settings), "");
    });
    return status;
}

std::string describe(const PictureSettings& settings) {
    std::string text;
    visitPictureRows([&](auto rows, const auto& part) {
        text += core::describeValues(rows, part(settings)) + " ";
    });
    return text;
}

} // namespace shutter::game
