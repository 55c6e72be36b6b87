// SPDX-License-Identifier: MIT
// A lens that zooms: the field of view of a camera at any time.
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/entity.h"
#include "engine/scene/key_interpolation.h"
#include "engine/scene/world.h"

#include <vector>

namespace shutter::scene {

struct LensKey {
    double seconds = 0.0;
    double yFov = 0.8; ///< vertical field of view, radians, (0, pi)
    bool cut = false;  ///< the lens jumps to this key: until then it stays at the key before
};

/// Component of a perspective camera: replaces Camera::yFov. Between keys the logarithm of the
/// focal length is interpolated: a zoom of even speed, inside (0, pi) whatever the keys. Before the
/// first key and after the last the lens stays there. A cut is a camera cut (history.h). Blur by
/// zooming is scaled with that by turning (CameraShutter::cameraRotationScale): neither depends on
/// depth.
struct LensMotion {
    std::vector<LensKey> keys; ///< one or more, at rising times
    PathInterpolation interpolation = PathInterpolation::CatmullRom;
    PathEase ease = PathEase::None;
};

/// One sentence that names the key and what is wrong with it.
[[nodiscard]] core::Status validateLens(const LensMotion& lens);

/// True when the lens jumps after `from` and not after `to`.
[[nodiscard]] bool hasCutWithin(const LensMotion& lens, double from, double to);

/// The one question after a camera's lens: its vertical field of view, radians, at `seconds`
/// (finite), whatever zooms it. Of an orthographic camera it has no meaning and never changes.
[[nodiscard]] double yFovAt(const World& world, ecs::Entity camera, double seconds);

/// False when yFovAt answers the same at every time.
[[nodiscard]] bool mayZoom(const World& world, ecs::Entity camera);

} // namespace shutter::scene
