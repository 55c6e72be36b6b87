// SPDX-License-Identifier: MIT
// The lens of a camera: how wide it is, what is in focus, and how the two change over time.
//
// A thin lens whose yFov is authoritative. With the focal length f = sensorHeight / (2 tan(yFov /
// 2)), the lens has the radius R = f / (2 fStop). Focused at F, it spreads a point of light at
// depth z over a circle of confusion of the diameter 2 s R |1/F - 1/z| pixels, where s is how many
// pixels a unit of x/z takes. Each place of the lens sees the scene as a pinhole there does,
// sheared so that what is at F stays where it is.
#pragma once

#include "engine/core/result.h"
#include "engine/core/setting_row.h"
#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/key_interpolation.h"
#include "engine/scene/world.h"
#include "shaders/common/aperture.glsl"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::scene {

struct FocusKey {
    double seconds = 0.0;
    std::optional<double> focusDistance; ///< as CameraLens's; in all keys or in none
    std::optional<double> fStop;         ///< as CameraLens's, above 0; in all keys or in none
    bool cut = false; ///< the lens jumps to this key; until then the one before holds
};

/// Component of a camera: replaces what its keys have of CameraLens. Between keys 1 / focusDistance
/// is interpolated, by which blur grows evenly, and the logarithm of fStop, by which light does.
/// Before the first key and after the last the lens keeps that key's values.
struct FocusMotion {
    std::vector<FocusKey> keys; ///< one or more, at rising times, of valid values
    PathInterpolation interpolation = PathInterpolation::CatmullRom;
    PathEase ease = PathEase::None;
};

/// One sentence that names the key and what is wrong with it.
[[nodiscard]] core::Status validateFocus(const FocusMotion& focus);

/// Farthest focus distance, metres: infinity, for the eye.
inline constexpr double kFarthestFocus = 1.0e9;
/// Nearest focus distance, metres.
inline constexpr double kNearestFocus = 1.0e-4;

/// The camera's lens at `seconds` (finite), whatever focuses it: LensOverride, else FocusMotion,
/// else AutoFocus (auto_focus.h), else CameraLens. A pinhole for a camera without one and for an
/// orthographic one, which has no focal length.
[[nodiscard]] CameraLens lensAt(const World& world, ecs::Entity camera, double seconds);

/// False: the camera is a pinhole at all times.
[[nodiscard]] bool hasLens(const World& world, ecs::Entity camera);

/// Half the height of the lens's opening, metres; 0: a pinhole.
/// \param yFov of the camera's frame, radians, (0, pi)
[[nodiscard]] double computeLensRadius(const CameraLens& lens, double yFov);

/// Diameter of the circle of confusion of a point, in the unit of `pixelsPerUnit`.
/// \param radius of the lens, metres
/// \param depth of the point along the axis, metres, above 0; may be infinite
/// \param pixelsPerUnit of the picture for one unit of x/z
[[nodiscard]] double
computeConfusionDiameter(const CameraLens& lens, double radius, double depth, double pixelsPerUnit);

/// Shape of the opening, for aperturePoint().
[[nodiscard]] shader::Aperture describeAperture(const CameraLens& lens);

/// One row per field of CameraLens (engine/core/setting_row.h).
[[nodiscard]] core::SettingRows<CameraLens> listLensRows();

/// One row per field of LensOverride.
[[nodiscard]] core::SettingRows<LensOverride> listOverrideRows();

/// Error: one sentence that names the field which is out of its range.
/// \param prefix before the field's name, e.g. "lens."
[[nodiscard]] core::Status validate(const CameraLens& lens, std::string_view prefix = "");
[[nodiscard]] core::Status validate(const LensOverride& lens, std::string_view prefix = "");

} // namespace shutter::scene
