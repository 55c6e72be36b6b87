// SPDX-License-Identifier: MIT
// The one question that motion vectors, rays and ground truth all ask.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/world.h"

namespace shutter::scene {

/// World transform of `entity` at `seconds`, whatever moves it: clips, velocity components, its
/// parents, or several of them. A clip gives the pose, velocities are added to it. Any time may be
/// asked for, in any order; nothing is integrated step by step, so the answer is exact.
[[nodiscard]] math::dmat4 worldFromEntity(const World& world, ecs::Entity entity, double seconds);

/// Time interval of the exposure around a frame's own time.
struct ExposureInterval {
    double open = 0.0;   ///< seconds
    double raster = 0.0; ///< seconds: when the raster image is taken
    double close = 0.0;  ///< seconds

    [[nodiscard]] double at(double s) const { return open + (close - open) * s; } ///< s in [0, 1]
    /// s of the raster instant: 0 start, 0.5 centre, 1 end.
    double rasterShare = 1.0;
};

[[nodiscard]] ExposureInterval computeExposure(const CameraShutter& shutter, double frameSeconds);

} // namespace shutter::scene
