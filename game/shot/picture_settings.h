// SPDX-License-Identifier: MIT
// Settings of a picture other than the motion blur's, shared by `render`, `bench` and `play`: the
// command line, the panel, the settings file, its schema and the fingerprint are loops over
// visitPictureRows().
#pragma once

#include "engine/core/setting_row.h"
#include "engine/extract/extracted_frame.h"
#include "modules/bloom/bloom.h"
#include "modules/particles/particle_settings.h"
#include "modules/shadows/shadow_settings.h"
#include "modules/tonemap/tonemap.h"

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace shutter::game {

/// How a picture of one raster image gets smooth edges.
enum class AntiAliasing : uint8_t {
    None, ///< none: one sample per pixel
    Taa,  ///< by the frames before (modules/taa)
    Box,  ///< by kBoxFrames frames of it, each of another place in the pixel, averaged
};

/// Of features that take part in a picture besides its effects (picture_features.h).
struct FeatureSettings {
    shadows::ShadowSettings shadows{};
    particles::ParticleSettings particles{};
};

/// Calls `visit(rows, part)` for each group of rows; `part(settings)` is the struct that the rows
/// describe. A feature is a member above and a line here.
template <class Visit> void visitFeatureRows(const Visit& visit) {
    visit(
        shadows::listShadowRows(), [](auto& settings) -> auto& { return settings.shadows; }
    );
    visit(
        particles::listParticleRows(), [](auto& settings) -> auto& { return settings.particles; }
    );
}

[[nodiscard]] bool areEqual(const FeatureSettings& a, const FeatureSettings& b);

/// extract::ViewRequest::unseenMatters
[[nodiscard]] bool unseenMatters(const FeatureSettings& settings);

struct PictureSettings {
    AntiAliasing antiAliasing = AntiAliasing::None;
    extract::FrameFit frameFit = extract::FrameFit::Whole;
    FeatureSettings features{};
    bloom::BloomSettings bloom{};
    tonemap::TonemapSettings tonemap{};
};

/// What a preset sets besides the method and the blur, the same in `render` and `play`. An
/// environment is drawn where there is one.
struct PresetEffects {
    /// A row of visitPictureRows() and its value as settings files have it.
    struct Value {
        std::string_view row;
        std::string_view text;
    };

    std::string_view preset;
    std::span<const Value> values;
    bool depthOfField; ///< false: cameras are pinholes
};

/// Null: the preset is about the blur alone, or there is none of this name.
[[nodiscard]] const PresetEffects* findPresetEffects(std::string_view preset);

/// For where there is no GPU: `performance` without what costs most (game/play/README.md).
inline constexpr std::string_view kPresetWithoutGpu = "performance without a GPU";

/// \param typed options whose rows remain as they are
void apply(
    const PresetEffects& effects, PictureSettings& settings, const std::set<std::string>& typed = {}
);

[[nodiscard]] bool isApplied(const PresetEffects& effects, const PictureSettings& settings);

/// Rows of what belongs to no module.
[[nodiscard]] core::SettingRows<PictureSettings> listPictureRows();

/// visitFeatureRows() for all of the settings. An effect that a picture can have is a member above
/// and a line here.
template <class Visit> void visitPictureRows(const Visit& visit) {
    using S = PictureSettings;
    const auto partOf = [](auto member) {
        return [member](auto& settings) -> auto& {
            return settings.*member;
        };
    };
    visit(
        listPictureRows(), [](auto& settings) -> auto& { return settings; }
    );
    visitFeatureRows([&](auto rows, const auto& part) {
        visit(
            rows, [part](auto& settings) -> auto& { return part(settings.features); }
        );
    });
    visit(bloom::listBloomRows(), partOf(&S::bloom));
    visit(tonemap::listTonemapRows(), partOf(&S::tonemap));
}

/// One sentence naming the field that is out of its range.
[[nodiscard]] core::Status validate(const PictureSettings& settings);

/// "antiAliasing=none frameFit=whole ...": differs wherever a value does.
[[nodiscard]] std::string describe(const PictureSettings& settings);

} // namespace shutter::game
