// SPDX-License-Identifier: MIT
// `shutter render`'s options as a person types them, and what they mean.
#pragma once

#include "engine/core/result.h"
#include "engine/flythrough/flythrough.h"
#include "engine/gpu/device_select.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/shutter.h"
#include "game/methods.h"
#include "game/shutter_options.h"
#include "modules/accumulate/accumulate.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"
#include "modules/tonemap/tonemap.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shutter::game {

/// As typed.
struct RenderArguments : ShutterArguments {
    std::string scene;
    std::string camera;
    double time = 0.0;
    std::string frames;
    std::string flythrough;
    double fps = 24.0;
    bool isFpsTyped = false; ///< else a flythrough's own counts
    std::vector<std::string> clips;
    bool loop = false;
    std::string method = "hybrid";
    uint32_t samples = 0;
    std::string pixel = "centre";
    uint32_t seed = 0;
    std::optional<double> error;
    std::string size = "1280x720";
    bool unlit = false;
    std::string background = "0.18,0.18,0.18";
    std::string ambient = "0.25,0.25,0.25";
    double exposureValue = 0.0;
    std::string tonemap = "neutral";
    std::vector<std::string> settings;
    std::string out;
    std::string ffmpeg;
    bool keepFrames = false;
    bool restart = false;
    std::string aov;
    std::string stats;
    std::string device;
    std::string rays;
    bool validate = false;
    bool dumpGraph = false;
    bool explain = false;
    std::optional<double> budgetMilliseconds;
    uint32_t repeat = 1;
    std::string pictureOptions; ///< describePictureOptions() of the command line
};

/// As meant: checked, in engine terms.
struct RenderOptions {
    std::filesystem::path scene;
    std::string camera;
    std::vector<double> frameTimes; ///< seconds
    int firstFrame = 0;             ///< number of the first file of a sequence
    bool isSequence = false;        ///< --frames or --flythrough was given
    std::optional<flythrough::Flythrough>
        flythrough;                   ///< of --flythrough FILE: who flies (flight.h)
    std::string flythroughHash;       ///< of its file
    bool isFlythroughShutter = false; ///< its keys' shutters count: no exposure was asked for
    std::string flythroughClip;       ///< of --flythrough clip:NAME
    std::vector<std::string> clips;
    bool loop = false;
    double fps = 24.0; ///< frames a second: --fps, or the flythrough's
    double frameSeconds = scene::kStillFrameSeconds; ///< a frame's duration, 1 / fps
    scene::CameraShutter shutter;
    const MethodInfo* method = nullptr;
    uint32_t samples = 0;
    accumulate::PixelModel pixel = accumulate::PixelModel::Centre;
    uint32_t seed = 0;
    std::optional<double> error; ///< of Truth: stop at this standard error, linear, above 0
    uint32_t width = 0;
    uint32_t height = 0;
    bool unlit = false;
    math::vec3 background{0.0f};
    math::vec3 ambient{0.0f};
    tonemap::TonemapSettings tonemap;
    motion_blur::MotionBlurSettings motionBlur;
    motion_blur::BlurBudget budget; ///< of motionBlur
    std::filesystem::path out;      ///< of a film: its frames'
    std::filesystem::path film;     ///< .mp4 to make of the frames; empty: none
    std::filesystem::path ffmpeg;   ///< empty: the one on PATH
    bool keepFrames = false;        ///< of a film, when it is made
    bool restart = false;           ///< draw frames anew that are complete on disk
    std::string pictureOptions;     ///< as typed, those that a picture depends on
    bool displayOut = false;        ///< .png or .jpg: tone-mapped; otherwise linear
    std::set<std::string> aovs;
    std::filesystem::path stats;
    std::string device;
    gpu::RayTier bestTier = gpu::RayTier::RayQuery; ///< --rays
    bool validate = false;
    bool dumpGraph = false;
    bool explain = false; ///< print why each effect and pass ran or was skipped
    uint32_t repeat = 1;
};

/// Of a shot: what is drawn when, from where, how it is lit and shown.
void defineShotOptions(CLI::App& command, RenderArguments& arguments);
void defineDeviceOptions(CLI::App& command, RenderArguments& arguments);
/// All of `shutter render`, the ones above included.
void defineRenderOptions(CLI::App& command, RenderArguments& arguments);

/// Checks everything that needs no file. Error: names the option that was used wrongly.
[[nodiscard]] core::Result<RenderOptions> interpret(const RenderArguments& arguments);

/// Sets frameTimes and firstFrame: frames `first` to `last`, both included, at `options.fps`.
/// Error: names `option`, there are too many or they lie beyond all time.
[[nodiscard]] core::Status
planFrames(const char* option, double first, double last, RenderOptions& options);

/// All options that were typed and that a picture may depend on, in one line; that is all but those
/// known to be of no matter. The scene, the device and the flythrough's file are told by content.
[[nodiscard]] std::string describePictureOptions(const CLI::App& command);

/// Before hours of rendering: whether --out and --stats can be written where they are to go.
[[nodiscard]] core::Status checkOutputs(const RenderOptions& options);

/// --out's file of one frame: %04d (any width) replaced by the frame's number.
[[nodiscard]] std::filesystem::path
frameFile(const std::filesystem::path& pattern, int frameNumber);

} // namespace shutter::game
