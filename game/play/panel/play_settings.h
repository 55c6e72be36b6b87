// SPDX-License-Identifier: MIT
// What a player sets and keeps from one session to the next.
#pragma once

#include "engine/core/result.h"
#include "engine/core/setting_row.h"
#include "engine/scene/components.h"
#include "game/shot/methods.h"
#include "game/shot/shot_options.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace shutter::game {

/// The shutter of a new player: half of the frame open, as film has it, and never longer than at 24
/// frames per second, so that a slow machine does not smear.
[[nodiscard]] scene::CameraShutter makePlayShutter();

/// What a new player sees: the effects of the preset `balanced`.
[[nodiscard]] PictureSettings makePlayPicture();

struct PlaySettings {
    std::string method = "resolved";  ///< of the picture, right of a split; a name of listMethods()
    std::string leftMethod = "sharp"; ///< left of a split
    bool split = false;
    double dividerShare = 0.5; ///< of the window's width, [0, 1]
    std::string view; ///< the intermediate that is shown (debug_view.h); empty: the picture
    motion_blur::MotionBlurSettings
        blur{}; ///< of every method that reads the field; `method` unused
    motion_blur::BlurBudget budget;
    /// Max share of a frame's GPU time that the blur takes, [0.05, 1]; 1: no limit. `budget`
    /// applies as well.
    double budgetShare = 1.0;
    scene::CameraShutter shutter = makePlayShutter();
    bool depthOfField = true; ///< false: cameras are pinholes, whatever `lens` is
    /// In place of the camera's own lens, for methods that have one.
    scene::LensOverride lens;
    /// Scale of the blur that the camera's own motion causes, [0, 1], for players whom it makes
    /// sick. At 0 only moving objects blur.
    double cameraBlurScale = 1.0;
    uint32_t instants = 16;    ///< instants per frame of `accumulate`, [1, 256]
    uint32_t rays = 4;         ///< rays per pixel and frame of `truth`, [1, 256]
    uint32_t denoisedRays = 1; ///< rays per pixel and frame of `denoised`, in place of
                               ///< blur.sampleCount, [1, 256]
    PictureSettings picture = makePlayPicture();
    bool environment = true;      ///< extract::ViewRequest::environment
    double resolutionScale = 1.0; ///< of the window's sides, [0.25, 1]
    bool vsync = true;
    double uiScale = 1.0; ///< of text and panel, on top of the display's own scale, [0.5, 4]
    bool showPanel = false;
};

/// What a method of modules/motion_blur gets: `blur` with the method, and with its own count where
/// samples are rays. \param method of MethodFamily::MotionBlur (CHECKed)
[[nodiscard]] motion_blur::MotionBlurSettings
makeBlurSettings(const PlaySettings& settings, const MethodInfo& method);

/// Changes the method, the blur and, if the preset is for players, the other effects. Turning the
/// blur off does not change the rest, so that the two pictures differ only in the blur.
void applyPreset(const Preset& preset, PlaySettings& settings);
/// The settings are as the preset makes them.
[[nodiscard]] bool isApplied(const Preset& preset, const PlaySettings& settings);

/// The budget of the blur where everything else of a frame takes `otherMilliseconds` of the GPU,
/// which is 0 if that is unknown: then budgetShare is no limit.
[[nodiscard]] motion_blur::BlurBudget
computeBudget(const PlaySettings& settings, double otherMilliseconds);

/// One sentence naming the field that is out of its range.
[[nodiscard]] core::Status validate(const PlaySettings& settings);

/// makeSettingsSchema() defines the file format. Missing fields have their defaults; whether `view`
/// names an intermediate is not checked. Error: names file, line and field.
[[nodiscard]] core::Result<PlaySettings> loadPlaySettings(const std::filesystem::path& path);
/// Renamed into place. Error: settings that validate() refuses, or names the file.
[[nodiscard]] core::Status
savePlaySettings(const std::filesystem::path& path, const PlaySettings& settings);

/// The text of a settings file with these settings, which must be valid.
[[nodiscard]] std::string formatPlaySettings(const PlaySettings& settings);

/// The JSON schema of a settings file, made of the rows.
[[nodiscard]] std::string makeSettingsSchema();

/// The shutter as the camera gets it: reduced motion applied.
[[nodiscard]] scene::CameraShutter makeShutter(const PlaySettings& settings);

/// The lens as the camera gets it: closed without depth of field.
[[nodiscard]] scene::LensOverride makeLens(const PlaySettings& settings);

/// Longest name of an intermediate, bytes.
inline constexpr size_t kMaxViewBytes = 64;

/// One row per field of PlaySettings, except for names (method, leftMethod, view) and for structs
/// with separate rows. In files they are siblings of the rows of visitPictureRows().
[[nodiscard]] core::SettingRows<PlaySettings> listPlayRows();

} // namespace shutter::game
