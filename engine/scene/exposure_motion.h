// SPDX-License-Identifier: MIT
// Motion as one exposure of one camera shows it: the one place that motion vectors, rays and ground
// truth ask where something is at a shutter time.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/deformation.h"
#include "engine/scene/motion.h"
#include "engine/scene/world.h"

namespace shutter::scene {

class ExposureMotion {
  public:
    /// \param camera alive, with a Camera; `world` must outlive this and stay as it is
    ExposureMotion(const World& world, ecs::Entity camera, const ExposureInterval& exposure)
        : mWorld(world), mCamera(camera), mExposure(exposure) {}

    [[nodiscard]] const ExposureInterval& exposure() const { return mExposure; }

    /// Shutter time s in [0, 1] below; `entity` and its parents are alive.
    [[nodiscard]] math::dmat4 worldFromEntity(ecs::Entity entity, double s) const;
    /// Of the space that deformed vertices are given in (deformation.h).
    [[nodiscard]] math::dmat4 worldFromObject(ecs::Entity entity, double s) const;
    [[nodiscard]] Deformation deformationAt(ecs::Entity entity, double s) const;
    /// Of the camera's entity; may hold scale.
    [[nodiscard]] math::dmat4 worldFromCamera(double s) const;

    /// False when worldFromEntity answers the same at every shutter time.
    [[nodiscard]] bool mayMove(ecs::Entity entity) const;
    /// False when worldFromObject answers the same at every shutter time.
    [[nodiscard]] bool mayObjectMove(ecs::Entity entity) const;
    /// False when deformationAt answers the same at every shutter time.
    [[nodiscard]] bool mayDeform(ecs::Entity entity) const;

  private:
    [[nodiscard]] double secondsAt(double s) const;

    const World& mWorld;
    ecs::Entity mCamera;
    ExposureInterval mExposure;
};

} // namespace shutter::scene
