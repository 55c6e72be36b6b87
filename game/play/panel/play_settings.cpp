// SPDX-License-Identifier: MIT
#include "game/play/panel/play_settings.h"

#include "engine/core/check.h"
#include "engine/scene/shutter.h"
#include "game/play/panel/play_rows.h"
#include "modules/motion_blur/setting_rows.h"

#include <algorithm>

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
        validateRows(motion_blur::listBudgetRows(), settings.budget, "budget."),
        validateRows(motion_blur::listSettingRows(), settings.blur, "blur."),
        scene::validate(settings.shutter, "shutter."),
    };
    for (const Status& check : checks)
        if (!check)
            return check;
    return {};
}

} // namespace

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
    if (Status names = validateNames(settings); !names)
        return names;
    return validateRowsOfAll(settings);
}

} // namespace shutter::game
