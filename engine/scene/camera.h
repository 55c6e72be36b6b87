// SPDX-License-Identifier: MIT
// Cameras: lenses that zoom, a camera that frames the scene, cuts found in a camera's motion.
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/entity.h"
#include "engine/math/bounds.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/key_interpolation.h"
#include "engine/scene/world.h"

#include <functional>
#include <vector>

namespace shutter::scene {

struct LensKey {
    double seconds = 0.0;
    double yFov = 0.8; ///< vertical field of view, radians, (0, pi)
    bool cut = false;  ///< the lens jumps to this key; until then the key before holds
};

/// Component of a perspective camera: replaces Camera::yFov. Between keys the logarithm of the
/// focal length is interpolated: a zoom of even speed that stays inside (0, pi) for any keys.
/// Before the first key and after the last the lens keeps that key's value. A cut is a camera cut
/// (history.h). CameraShutter::cameraRotationScale scales the blur of zooming as it does that of
/// turning: neither depends on depth.
struct LensMotion {
    std::vector<LensKey> keys; ///< one or more, at rising times
    PathInterpolation interpolation = PathInterpolation::CatmullRom;
    PathEase ease = PathEase::None;
};

/// Error: one sentence that names the key and the fault.
[[nodiscard]] core::Status validateLens(const LensMotion& lens);

/// True when the lens jumps after `from` and not after `to`.
[[nodiscard]] bool hasCutWithin(const LensMotion& lens, double from, double to);

/// The camera's vertical field of view, radians, at `seconds` (finite), including zooms. Constant
/// and without meaning for an orthographic camera.
[[nodiscard]] double yFovAt(const World& world, ecs::Entity camera, double seconds);

/// False when yFovAt answers the same at every time.
[[nodiscard]] bool mayZoom(const World& world, ecs::Entity camera);

/// World bounds of everything that is drawn, at `seconds`. Empty for an empty scene.
[[nodiscard]] math::Bounds computeWorldBounds(const World& world, double seconds);

/// Adds a camera that sees the whole scene from the front, a little above, and returns its entity.
/// It is the last of world.cameras. Works for scenes of any size, empty ones and single points too.
/// \param aspect width / height of the picture, above 0
ecs::Entity addFramingCamera(World& world, double aspect, double seconds);

/// Rigid matrix (worldFromRigid) of the camera at a time, seconds.
using PoseAt = std::function<math::dmat4(double seconds)>;

/// Detects a camera cut without an event: true when the pose jumps between `from` and `to` by the
/// detection's angle or distance or more. Intervals that change so much are halved 30 times: the
/// change of a smooth motion shrinks with the interval, a jump does not. Poses that are not finite
/// are ignored. False when detection is off.
[[nodiscard]] bool
findsCameraCut(const PoseAt& poseAt, double from, double to, const CutDetection& detection);

} // namespace shutter::scene
