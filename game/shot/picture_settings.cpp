// SPDX-License-Identifier: MIT
#include "game/shot/picture_settings.h"

#include "engine/core/check.h"

#include <algorithm>
#include <array>

namespace shutter::game {

namespace {

using Value = PresetEffects::Value;

constexpr std::array kFast = {
    Value{"antiAliasing", "none"}, Value{"shadows", "blurred"}, Value{"bloomShare", "0"}};
constexpr std::array kFastWithoutGpu = {
    Value{"antiAliasing", "none"}, Value{"shadows", "none"}, Value{"bloomShare", "0"}};
constexpr std::array kGood = {
    Value{"antiAliasing", "taa"}, Value{"shadows", "blurred"}, Value{"bloomShare", "0.04"}};

/// Calls `visit(row, part)` for the row of each value.
template <class Visit> void visitValues(const PresetEffects& effects, const Visit& visit) {
    for (const Value& value : effects.values) {
        bool isFound = false;
        visitPictureRows([&](auto rows, const auto& part) {
            if (const auto* row = core::findRow(rows, value.row)) {
                isFound = true;
                visit(*row, part, std::string(value.text));
            }
        });
        SHUTTER_CHECK(isFound, "the preset '{}' sets {}", effects.preset, value.row);
    }
}

} // namespace

const PresetEffects* findPresetEffects(std::string_view preset) {
    static constexpr std::array kEffects = {
        PresetEffects{"performance", kFast, false},
        PresetEffects{kPresetWithoutGpu, kFastWithoutGpu, false},
        PresetEffects{"balanced", kGood, true},
        PresetEffects{"quality", kGood, true},
    };
    const auto found =
        std::find_if(kEffects.begin(), kEffects.end(), [&](const PresetEffects& effects) {
            return effects.preset == preset;
        });
    return found == kEffects.end() ? nullptr : &*found;
}

void apply(
    const PresetEffects& effects, PictureSettings& settings, const std::set<std::string>& typed
) {
    visitValues(effects, [&](const auto& row, const auto& part, const std::string& text) {
        if (typed.contains(row.option))
            return;
        const core::Status parsed = core::parseValue(row, text, part(settings));
        SHUTTER_CHECK(parsed.ok(), "{}: {}", row.name, parsed.error().message);
    });
}

bool isApplied(const PresetEffects& effects, const PictureSettings& settings) {
    bool applied = true;
    visitValues(effects, [&](const auto& row, const auto& part, const std::string& text) {
        applied = applied && core::describeValue(row, part(settings)) == text;
    });
    return applied;
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
