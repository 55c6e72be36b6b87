// SPDX-License-Identifier: MIT
#include "engine/scene/exposure_motion.h"

namespace shutter::scene {

double ExposureMotion::secondsAt(double s) const {
    // Not one rounding beside it: the raster image and a still one of the same time are the same.
    return s == mExposure.rasterShare ? mExposure.raster : mExposure.at(s);
}

math::dmat4 ExposureMotion::worldFromEntity(ecs::Entity entity, double s) const {
    return scene::worldFromEntity(mWorld, entity, secondsAt(s));
}

math::dmat4 ExposureMotion::worldFromObject(ecs::Entity entity, double s) const {
    return scene::worldFromObject(mWorld, entity, secondsAt(s));
}

Deformation ExposureMotion::deformationAt(ecs::Entity entity, double s) const {
    return scene::deformationAt(mWorld, entity, secondsAt(s));
}

math::dmat4 ExposureMotion::worldFromCamera(double s) const {
    return worldFromEntity(mCamera, s);
}

bool ExposureMotion::mayMove(ecs::Entity entity) const {
    return scene::mayMove(mWorld, entity);
}

bool ExposureMotion::mayObjectMove(ecs::Entity entity) const {
    return scene::mayObjectMove(mWorld, entity);
}

bool ExposureMotion::mayDeform(ecs::Entity entity) const {
    return scene::mayDeform(mWorld, entity);
}

} // namespace shutter::scene
