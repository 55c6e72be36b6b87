// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_keys.h"

#include "engine/math/math.h"
#include "modules/motion_blur/embedding/host_ways.h"

namespace shutter::motion_blur {

namespace {

/// Moves the picture left and up by the jitter, since its samples lie right and down of the pixels'
/// centres.
glm::dmat4 addJitter(const glm::dmat4& clipFromView, const glm::dvec2& jitterPx, VkExtent2D size) {
    glm::dmat4 rows = glm::transpose(clipFromView);
    rows[0] -= 2.0 * jitterPx.x / size.width * rows[3];
    rows[1] -= 2.0 * jitterPx.y / size.height * rows[3];
    return glm::transpose(rows);
}

} // namespace

bool derivesKeys(const HostInputs& inputs, const MotionBlurSettings& wanted) {
    if (!inputs.motion.keys.empty() || !inputs.convention.cameras.areGiven ||
        inputs.motionDepth.image)
        return false;
    if (wanted.method)
        return wanted.method->readsInstantMotions;
    return !inputs.convention.vectors.image.image || !inputs.motion.movers.empty();
}

const char* describeMissingKeys(const HostInputs& inputs) {
    if (inputs.motionDepth.image)
        return "motionDepth is given without keys";
    if (!inputs.convention.cameras.areGiven)
        return "neither keys nor cameras are given";
    return "vectors are given without keys or movers";
}

std::array<HostCameraKey, 2> deriveKeys(const HostInputs& inputs) {
    const HostCameras cameras = countedCameras(inputs.convention);
    const VkExtent2D size{inputs.width, inputs.height};
    const auto project = [&](const glm::dmat4& clipFromView) {
        return addJitter(clipFromView, cameras.jitterPx, size);
    };
    return {{
        {timeOfFrameBefore(inputs),
         cameras.viewFromWorldBefore,
         project(cameras.clipFromViewBefore)},
        {inputs.rasterTime, cameras.viewFromWorld, project(cameras.clipFromView)},
    }};
}

} // namespace shutter::motion_blur
