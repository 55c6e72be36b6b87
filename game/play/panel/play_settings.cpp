// SPDX-License-Identifier: MIT
#include "game/play/panel/play_settings.h"

#include "engine/core/check.h"
#include "engine/scene/lens.h"
#include "engine/scene/shutter.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"

#include <algorithm>
#include <array>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;

Status validateNames(const PlaySettings& settings) {
    for (const auto& [field, name] :
         {std::pair("method", &settings.method), std::pair("leftMethod", &settings.leftMethod)})
        if (!findMethod(*name))
            return makeError("{}: there is no method '{}'", field, *name);
    if (settings.view.size() > kMaxViewBytes)
        return makeError(
            "view is a name of {} bytes, it must have at most {}",
            settings.view.size(),
            kMaxViewBytes
        );
    return {};
}

Status validateRowsOfAll(const PlaySettings& settings) {
    const Status checks[] = {
        validateRows(listPlayRows(), settings, ""),
        validate(settings.picture),
        validateRows(motion_blur::listBudgetRows(), settings.budget, "budget."),
        validateRows(motion_blur::listSettingRows(), settings.blur, "blur."),
        scene::validate(settings.shutter, "shutter."),
        scene::validate(settings.lens, "lens."),
    };
    for (const Status& check : checks)
        if (!check)
            return check;
    return {};
}

bool isSharp(const Preset& preset) {
    return std::string_view(preset.method) == "sharp";
}

bool isSeen(const PresetEffects* effects, const PlaySettings& settings) {
    return !effects || (isApplied(*effects, settings.picture) && settings.environment &&
                        settings.depthOfField == effects->depthOfField);
}

} // namespace

void applyPreset(const Preset& preset, PlaySettings& settings) {
    settings.method = preset.method;
    if (!isSharp(preset))
        settings.blur = preset.blur;
    const PresetEffects* effects = findPresetEffects(preset.name);
    if (!effects)
        return;
    apply(*effects, settings.picture);
    settings.environment = true;
    settings.depthOfField = effects->depthOfField;
}

bool isApplied(const Preset& preset, const PlaySettings& settings) {
    return settings.method == preset.method && isSeen(findPresetEffects(preset.name), settings) &&
           (isSharp(preset) ||
            core::areEqual(motion_blur::listSettingRows(), settings.blur, preset.blur));
}

motion_blur::BlurBudget computeBudget(const PlaySettings& settings, double otherMilliseconds) {
    motion_blur::BlurBudget budget = settings.budget;
    // What the blur gives up makes the frame shorter, too: hence of the rest, not of the frame.
    if (settings.budgetShare < 1.0 && otherMilliseconds > 0.0)
        budget.milliseconds = std::min(
            budget.milliseconds,
            otherMilliseconds * settings.budgetShare / (1.0 - settings.budgetShare)
        );
    return budget;
}

PictureSettings makePlayPicture() {
    PictureSettings picture;
    apply(*findPresetEffects("balanced"), picture);
    return picture;
}

scene::CameraShutter makePlayShutter() {
    scene::CameraShutter shutter;
    shutter.mode = scene::ShutterMode::Capped;
    return shutter;
}

scene::CameraShutter makeShutter(const PlaySettings& settings) {
    scene::CameraShutter shutter = settings.shutter;
    shutter.cameraRotationScale *= settings.cameraBlurScale;
    shutter.cameraTranslationScale *= settings.cameraBlurScale;
    return shutter;
}

scene::LensOverride makeLens(const PlaySettings& settings) {
    scene::LensOverride lens = settings.lens;
    if (!settings.depthOfField)
        lens.blurScale = 0.0;
    return lens;
}

motion_blur::MotionBlurSettings
makeBlurSettings(const PlaySettings& settings, const MethodInfo& method) {
    SHUTTER_CHECK(method.blur, "{} is no motion blur", method.name);
    motion_blur::MotionBlurSettings blur = settings.blur;
    blur.method = method.blur;
    if (method.sampleUnit == SampleUnit::Rays)
        blur.sampleCount = settings.denoisedRays;
    return blur;
}

core::Status validate(const PlaySettings& settings) {
    SHUTTER_TRY(validateNames(settings));
    return validateRowsOfAll(settings);
}

core::SettingRows<PlaySettings> listPlayRows() {
    using S = PlaySettings;
    static const std::vector<core::SettingRow<S>> kRows = {
        {"cameraBlurScale",
         &S::cameraBlurScale,
         "",
         {.lowest = 0, .highest = 1},
         "Scales the blur that the camera's own motion causes, for players whom it makes sick. At "
         "0 only movers blur.",
         "Camera blur"},
        {"budgetShare",
         &S::budgetShare,
         "",
         {.lowest = 0.05, .highest = 1},
         "Share of a frame's GPU time that the blur may take. To stay within it, the blur gives up "
         "what the budget in milliseconds takes away, too. 1 is no limit.",
         "Budget, share"},
        {"depthOfField",
         &S::depthOfField,
         "",
         {},
         "Blur of what is out of focus, where the camera has a lens. Off is faster.",
         "Depth of field"},
        {"split",
         &S::split,
         "",
         {},
         "Another method's picture left of the divider.",
         "Split screen"},
        {"dividerShare",
         &S::dividerShare,
         "",
         {.lowest = 0, .highest = 1},
         "Place of the divider, as a share of the window's width.",
         "Divider"},
        {"instants",
         &S::instants,
         "instants",
         {.lowest = 1, .highest = 256, .step = 1, .isLogarithmic = true},
         "Sharp frames that accumulate averages for each picture. Time is proportional to it.",
         "Sharp frames"},
        {"rays",
         &S::rays,
         "rays",
         {.lowest = 1, .highest = 256, .step = 1, .isLogarithmic = true},
         "Rays per pixel and picture of truth. Time is proportional to it.",
         "Rays"},
        {"denoisedRays",
         &S::denoisedRays,
         "rays",
         {.lowest = 1, .highest = 256, .step = 1, .isLogarithmic = true},
         "Rays per pixel and picture of denoised. Time is proportional to it.",
         "Rays, denoised"},
        {"environment",
         &S::environment,
         "",
         {},
         "The sky or picture around the scene, where it has one: it is seen, and it lights. Off: "
         "one colour.",
         "Sky"},
        {"resolutionScale",
         &S::resolutionScale,
         "",
         {.lowest = 0.25, .highest = 1},
         "Sides of the picture as a share of the window's. Lower is faster.",
         "Resolution"},
        {"vsync", &S::vsync, "", {}, "Frames wait for the display: no tearing.", "Vsync"},
        {"uiScale",
         &S::uiScale,
         "x",
         {.lowest = 0.5, .highest = 4},
         "Size of text and panel, in addition to the display's own scale.",
         "Text size"},
        {"showPanel", &S::showPanel, "", {}, "This panel (F1).", "Panel"},
    };
    return kRows;
}

} // namespace shutter::game
