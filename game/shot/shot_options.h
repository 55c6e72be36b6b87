// SPDX-License-Identifier: MIT
// Options of a shot and its method, validated and in engine types. game/options makes them from the
// command line.
#pragma once

#include "engine/core/frame_rate.h"
#include "engine/environment/environment.h"
#include "engine/flythrough/flythrough.h"
#include "engine/io/uri.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/shutter.h"
#include "game/shot/methods.h"
#include "game/shot/picture_settings.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

/// Times and exposures beyond it (32 years) have no meaning, and their sums must stay finite.
inline constexpr double kMaxSeconds = 1.0e9;

/// A scene, its camera, frames, lighting and appearance.
struct ShotOptions {
    std::filesystem::path scene;
    io::Reach reach = io::Reach::Folder; ///< the files that the scene, or a script, may name
    std::string camera;                  ///< name or index; empty: the first
    /// When a camera made to fit the scene fits it, seconds; nothing: in the first frame.
    std::optional<double> framingSeconds;
    std::vector<std::string> clips; ///< names or indices, or "none"; empty: all (selectClips)
    bool loop = false;
    std::vector<double> frameTimes; ///< seconds
    int firstFrame = 0;             ///< number of the first file of a sequence
    bool isSequence = false;        ///< of numbered frames, even if there is only one
    core::FrameRate fps;            ///< frames per second
    double frameSeconds = scene::kStillFrameSeconds;  ///< duration of a frame, 1 / fps
    std::optional<flythrough::Flythrough> flythrough; ///< of --flythrough FILE
    std::string flythroughHash;                       ///< of its file
    bool isFlythroughShutter =
        false;                  ///< no option sets a shutter, so the flythrough's shutters apply
    std::string flythroughClip; ///< of --flythrough clip:NAME|INDEX
    scene::CameraShutter shutter{};
    /// Methods that have a lens (MethodInfo::hasLens) draw with the camera's lens; false: all draw
    /// with a pinhole.
    bool usesLens = false;
    std::optional<double> fStop;         ///< in place of the camera's, at all times
    std::optional<double> focusDistance; ///< likewise, metres
    std::string focusEntity;             ///< likewise, a node's name; not with focusDistance
    uint32_t width = 0;                  ///< pixels
    uint32_t height = 0;                 ///< pixels
    bool unlit = false;
    math::vec3 background{0.0f};                     ///< linear
    math::vec3 ambient{0.0f};                        ///< linear
    std::filesystem::path environment;               ///< a picture of all directions; empty: none
    environment::EnvironmentSettings surroundings{}; ///< of `environment`
    double turbidity = 0.0;                          ///< of a clear sky; 0: no sky
    PictureSettings picture{};
    extract::PixelModel pixel = extract::PixelModel::Centre;
    uint32_t seed = 0; ///< of random times and places in the pixel
};

/// A method and how much work it does.
struct MethodOptions {
    const MethodInfo* method = nullptr;
    uint32_t samples = 0;        ///< in the method's sample unit
    std::optional<double> error; ///< truth: stop at this standard error, linear, above 0
    /// accumulate: as many instants as it takes for nothing visible to move farther than this
    /// between two of them, pixels, above 0; `samples` at most. Nothing: `samples` instants. Not
    /// for views that use a lens (CHECKed).
    std::optional<double> maxStepPx;
    motion_blur::MotionBlurSettings motionBlur{};
    uint32_t lensTaps = 0;            ///< of MethodInfo::lensFilter; 0: there is none
    motion_blur::BlurBudget budget{}; ///< of motionBlur
};

} // namespace shutter::game
