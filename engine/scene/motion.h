// SPDX-License-Identifier: MIT
// The one question that motion vectors, rays and ground truth all ask.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/world.h"

#include <cmath>

namespace shutter::scene {

/// World transform of `entity` at `seconds`, whatever moves it: clips, velocity components, its
/// parents, or several of them. A clip gives the pose, velocities are added to it. Any time may be
/// asked for, in any order; nothing is integrated step by step, so the answer is exact. `entity` and
/// its parents must be alive, `seconds` finite. An entity without a transform sits at its parent.
[[nodiscard]] math::dmat4 worldFromEntity(const World& world, ecs::Entity entity, double seconds);

/// False when nothing that could move `entity` is on it or on one of its parents: worldFromEntity
/// then answers the same at every time.
[[nodiscard]] bool mayMove(const World& world, ecs::Entity entity);

/// Time interval of the exposure around a frame's own time.
struct ExposureInterval {
    double open = 0.0;   ///< seconds
    double raster = 0.0; ///< seconds: when the raster image is taken
    double close = 0.0;  ///< seconds

    [[nodiscard]] double at(double s) const { return std::lerp(open, close, s); } ///< s in [0, 1]
    /// s of the raster instant: 0 start, 0.5 centre, 1 end.
    double rasterShare = 1.0;
};

/// Exposure times that are negative or not finite count as 0: open, raster and close are one.
[[nodiscard]] ExposureInterval computeExposure(const CameraShutter& shutter, double frameSeconds);

} // namespace shutter::scene
