// SPDX-License-Identifier: MIT
#include "engine/scene/lens.h"

#include "engine/core/check.h"
#include "engine/scene/auto_focus.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace shutter::scene {

namespace {

/// Below it a lens is metres wide at usual fields of view.
constexpr double kMinFStop = 0.01;
constexpr double kMaxFStop = 1.0e9;
constexpr uint32_t kMinBlades = 3;

double focusAt(const FocusMotion& motion, const KeyPlace& place) {
    const double from = *motion.keys[place.key].focusDistance;
    // Relative to the key before, so that a lens at rest changes no bit.
    const double change =
        interpolateAtPlace<double>(motion.keys, motion.interpolation, place, [&](size_t key) {
            return 1.0 / *motion.keys[key].focusDistance - 1.0 / from;
        });
    // A smooth curve may overshoot infinity.
    return change == 0.0
               ? from
               : 1.0 / std::clamp(1.0 / from + change, 1.0 / kFarthestFocus, 1.0 / kNearestFocus);
}

double fStopAt(const FocusMotion& motion, const KeyPlace& place) {
    const double from = *motion.keys[place.key].fStop;
    const double change =
        interpolateAtPlace<double>(motion.keys, motion.interpolation, place, [&](size_t key) {
            return std::log(*motion.keys[key].fStop / from);
        });
    return change == 0.0 ? from : std::clamp(from * std::exp(change), kMinFStop, kMaxFStop);
}

void applyKeys(const FocusMotion& motion, double seconds, CameraLens& lens) {
    SHUTTER_CHECK(!motion.keys.empty(), "a focus without keys");
    const KeyPlace place = findKeyPlace(motion.keys, motion.ease, seconds);
    if (motion.keys.front().focusDistance)
        lens.focusDistance = focusAt(motion, place);
    if (motion.keys.front().fStop)
        lens.fStop = fStopAt(motion, place);
}

core::Status validateFStop(double fStop, std::string_view prefix) {
    if (fStop == 0.0 || fStop >= kMinFStop)
        return {};
    return core::makeError("{}fStop is {}, it must be 0 or at least {}", prefix, fStop, kMinFStop);
}

/// As the camera's row of that name, from 0 on.
core::SettingRow<LensOverride>
overrideRow(const char* name, double LensOverride::*field, const char* meaning, const char* label) {
    const core::SettingRow<CameraLens>& row = core::getRow(listLensRows(), name);
    core::NumberRange range = row.range;
    range.lowest = 0.0;
    return {row.name, field, row.unit, range, meaning, label};
}

} // namespace

core::Status validateFocus(const FocusMotion& focus) {
    if (focus.keys.empty())
        return core::makeError("focus: it has no keys");
    const FocusKey& first = focus.keys.front();
    for (size_t i = 0; i < focus.keys.size(); ++i) {
        const FocusKey& key = focus.keys[i];
        if (!std::isfinite(key.seconds))
            return core::makeError("focus: the time of key {} is {}", i, key.seconds);
        if (i > 0 && !(key.seconds > focus.keys[i - 1].seconds))
            return core::makeError(
                "focus: key {} at {} s does not come after the one before, at {} s",
                i,
                key.seconds,
                focus.keys[i - 1].seconds
            );
        if (key.focusDistance.has_value() != first.focusDistance.has_value() ||
            key.fStop.has_value() != first.fStop.has_value())
            return core::makeError("focus: key {} has other fields than the first", i);
        CameraLens lens;
        lens.focusDistance = key.focusDistance.value_or(lens.focusDistance);
        lens.fStop = key.fStop.value_or(kMaxFStop);
        if (core::Status valid = validate(lens, fmt::format("focus: key {}: ", i)); !valid)
            return valid;
        if (lens.fStop == 0.0)
            return core::makeError("focus: the fStop of key {} is 0", i);
    }
    return {};
}

CameraLens lensAt(const World& world, ecs::Entity camera, double seconds) {
    SHUTTER_CHECK(std::isfinite(seconds), "lensAt {} seconds", seconds);
    if (world.registry.get<Camera>(camera).kind == CameraKind::Orthographic)
        return {};
    const auto* own = world.registry.find<CameraLens>(camera);
    CameraLens lens = own ? *own : CameraLens{};
    if (const auto distance = autoFocusAt(world, camera, seconds))
        lens.focusDistance = *distance;
    if (const auto* motion = world.registry.find<FocusMotion>(camera))
        applyKeys(*motion, seconds, lens);
    if (const auto* viewer = world.registry.find<LensOverride>(camera)) {
        lens.fStop = viewer->fStop != 0.0 ? viewer->fStop : lens.fStop;
        lens.focusDistance =
            viewer->focusDistance != 0.0 ? viewer->focusDistance : lens.focusDistance;
        lens.blurScale *= viewer->blurScale;
    }
    return lens;
}

bool hasLens(const World& world, ecs::Entity camera) {
    if (world.registry.get<Camera>(camera).kind == CameraKind::Orthographic)
        return false;
    const auto* own = world.registry.find<CameraLens>(camera);
    const CameraLens lens = own ? *own : CameraLens{};
    const auto* motion = world.registry.find<FocusMotion>(camera);
    const bool isOpened = motion && !motion->keys.empty() && motion->keys.front().fStop;
    const auto* viewer = world.registry.find<LensOverride>(camera);
    const bool opens = viewer && viewer->fStop != 0.0;
    const bool closes = viewer && viewer->blurScale == 0.0;
    return (lens.fStop != 0.0 || isOpened || opens) && lens.blurScale != 0.0 && !closes;
}

double computeLensRadius(const CameraLens& lens, double yFov) {
    if (lens.fStop == 0.0)
        return 0.0;
    const double focalLength = lens.sensorHeight / (2.0 * std::tan(yFov / 2.0));
    return lens.blurScale * focalLength / (2.0 * lens.fStop);
}

double computeConfusionDiameter(
    const CameraLens& lens, double radius, double depth, double pixelsPerUnit
) {
    return 2.0 * pixelsPerUnit * radius * std::abs(1.0 / lens.focusDistance - 1.0 / depth);
}

shader::Aperture describeAperture(const CameraLens& lens) {
    return {lens.blades, float(lens.bladeRotation), float(lens.roundness), float(lens.squeeze)};
}

core::SettingRows<CameraLens> listLensRows() {
    using L = CameraLens;
    static const std::array<core::SettingRow<L>, 8> kRows = {{
        {"fStop",
         &L::fStop,
         "",
         {.lowest = 0,
          .highest = kMaxFStop,
          .isLogarithmic = true,
          .sliderLowest = 0.5,
          .sliderHighest = 64},
         "F-number of the lens: focal length by width of its opening, at least 0.01. 0 is a "
         "pinhole, all sharp.",
         "F-number",
         "--fstop"},
        {"focusDistance",
         &L::focusDistance,
         "m",
         {.lowest = kNearestFocus,
          .highest = kFarthestFocus,
          .isLogarithmic = true,
          .sliderLowest = 0.1,
          .sliderHighest = 100},
         "Focus distance, along the camera's axis.",
         "Focus",
         "--focus"},
        {"sensorHeight",
         &L::sensorHeight,
         "m",
         {.lowest = 1.0e-4, .highest = 10, .isLogarithmic = true},
         "Height of the sensor, which with the field of view gives the focal length.",
         "Sensor height"},
        {"blades",
         &L::blades,
         "",
         {.lowest = 0, .highest = 16, .step = 1},
         "Sides of the opening, 3 or more; 0 is a disc.",
         "Blades"},
        {"bladeRotation",
         &L::bladeRotation,
         "rad",
         {.lowest = -2.0 * std::numbers::pi, .highest = 2.0 * std::numbers::pi},
         "Angle of the opening's first corner from the right, counterclockwise.",
         "Blade rotation"},
        {"roundness",
         &L::roundness,
         "",
         {.lowest = 0, .highest = 1},
         "How much the sides bulge: 0 is straight, 1 a disc.",
         "Roundness"},
        {"squeeze",
         &L::squeeze,
         "",
         {.lowest = 0, .highest = 4, .isLowestValid = false},
         "Width of the opening by its height; below 1 as in anamorphic lenses.",
         "Squeeze"},
        {"blurScale",
         &L::blurScale,
         "x",
         {.lowest = 0, .highest = 2},
         "Scales the blur, for those who dislike it.",
         "Blur"},
    }};
    return kRows;
}

core::SettingRows<LensOverride> listOverrideRows() {
    using L = LensOverride;
    static const std::array<core::SettingRow<L>, 3> kRows = {{
        overrideRow(
            "fStop",
            &L::fStop,
            "F-number in place of the camera's, at least 0.01: lower is more blur. 0 is the "
            "camera's own; without one it is a pinhole, all sharp.",
            "F-number"
        ),
        overrideRow(
            "focusDistance",
            &L::focusDistance,
            "Focus distance, along the camera's axis, in place of the camera's, at "
            "least 0.0001. 0 is the camera's own.",
            "Focus"
        ),
        overrideRow(
            "blurScale",
            &L::blurScale,
            "Scales the blur of what is out of focus, for players who dislike it. 0: none.",
            "Blur out of focus"
        ),
    }};
    return kRows;
}

core::Status validate(const LensOverride& lens, std::string_view prefix) {
    SHUTTER_TRY(core::validateRows(listOverrideRows(), lens, prefix));
    SHUTTER_TRY(validateFStop(lens.fStop, prefix));
    if (lens.focusDistance != 0.0 && lens.focusDistance < kNearestFocus)
        return core::makeError(
            "{}focusDistance is {}, it must be 0 or at least {}",
            prefix,
            lens.focusDistance,
            kNearestFocus
        );
    return {};
}

core::Status validate(const CameraLens& lens, std::string_view prefix) {
    SHUTTER_TRY(core::validateRows(listLensRows(), lens, prefix));
    SHUTTER_TRY(validateFStop(lens.fStop, prefix));
    if (lens.blades != 0 && lens.blades < kMinBlades)
        return core::makeError("{}blades is {}, it must be 0 or 3 to 16", prefix, lens.blades);
    return {};
}

} // namespace shutter::scene
