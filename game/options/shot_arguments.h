// SPDX-License-Identifier: MIT
// Options of a shot as typed: what is drawn when, from where, how it is lit and shown.
#pragma once

#include "engine/core/frame_rate.h"
#include "engine/core/result.h"
#include "game/options/picture_size.h"
#include "game/options/shutter_options.h"
#include "game/shot/shot_options.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace shutter::game {

struct ShotArguments {
    std::string scene;
    bool allowOutside = false;
    std::string camera;
    extract::FrameFit frameFit = extract::FrameFit::Whole;
    std::optional<double> framingTime; ///< seconds; else that of the first frame drawn
    double time = 0.0;
    std::string frames;
    std::string flythrough;
    std::optional<core::FrameRate> fps; ///< else the flythrough's, or 24
    std::vector<std::string> clips;
    bool loop = false;
    ShutterArguments shutter;
    extract::PixelModel pixel = extract::PixelModel::Centre;
    uint32_t seed = 0;
    AntiAliasing antiAliasing = AntiAliasing::None;
    PictureSize size{1280, 720};
    bool unlit = false;
    math::vec3 background{0.18f};
    math::vec3 ambient{0.25f};
    std::string environment; ///< file; empty: none
    double environmentIntensity = environment::EnvironmentSettings{}.intensity;
    double environmentRotation = 0.0; ///< degrees
    double sky = 0.0;                 ///< turbidity; 0: no sky
    float bloom = 0.0f;               ///< share of the light of highlights
    float bloomThreshold = bloom::BloomSettings().threshold;
    float bloomKnee = bloom::BloomSettings().knee;
    extract::ShadowMode shadows = extract::ShadowMode::None;
    uint32_t shadowMapSize = extract::ShadowSettings{}.mapSize;
    double shadowDistance = 0.0;
    uint32_t shadowInstants = extract::ShadowSettings{}.instants;
    double exposureValue = 0.0;
    tonemap::Operator tonemap = tonemap::Operator::Neutral;
};

/// Words of --tonemap.
inline constexpr std::string_view kTonemapWords[] = {"none", "neutral"};

/// The options that every shot has; not those of `shutter render` alone (defineFrameOptions).
void defineShotOptions(CLI::App& command, ShotArguments& arguments);
/// --allow-outside, which defineShotOptions() includes.
void defineOutsideOption(CLI::App& command, ShotArguments& arguments);
/// --tonemap and --ev, which defineShotOptions() includes.
std::vector<CLI::Option*> defineTonemapOptions(CLI::App& command, ShotArguments& arguments);
/// --size, --frames, --flythrough, --bloom and --aa. To be called after defineShotOptions().
void defineFrameOptions(CLI::App& command, ShotArguments& arguments);

/// Checks everything that needs no file. The flythrough is named but not read:
/// loadFlythrough(). Error: names the option that was used wrongly.
[[nodiscard]] core::Result<ShotOptions> interpret(const ShotArguments& arguments);

/// Error: --ev is out of its range.
[[nodiscard]] core::Result<tonemap::TonemapSettings> interpretTonemap(const ShotArguments& arguments
);

/// Reads the file that `arguments.flythrough` names and plans its frames, unless --frames did; the
/// file's frame rate counts unless --fps was typed, and its shutters unless the exposure was.
/// Does nothing if there is no flythrough or if it is a clip. Error: names the file and the field.
[[nodiscard]] core::Status loadFlythrough(const ShotArguments& arguments, ShotOptions& options);

/// All values that pictures depend on, in one line. The scene and the flythrough are not among
/// them, nor which frames are drawn.
[[nodiscard]] std::string describe(const ShotArguments& arguments);

} // namespace shutter::game
