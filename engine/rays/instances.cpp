// SPDX-License-Identifier: MIT
#include "engine/rays/instances.h"

#include "engine/extract/frame_view.h"
#include "engine/math/bounds.h"

namespace shutter::rays {

namespace {

void narrow(gpu::Instance& instance, uint32_t solidMask) {
    if ((instance.mask & shader::kSolidMask) != 0)
        instance.mask = (instance.mask & ~shader::kSolidMask) | solidMask;
}

} // namespace

gpu::Instance describeInstance(const gpu_scene::GpuScene& scene, const DeformedInstance& deformed) {
    gpu::Instance instance = scene.describeInstance(deformed.mesh);
    instance.blas = deformed.blas;
    instance.flipFacing = deformed.mirrored;
    return instance;
}

bool InstanceList::add(
    uint32_t row, uint32_t mesh, const math::vec4 (&relWorldFromObject)[3], uint32_t solidMask
) {
    if (!mScene.blas(mesh))
        return false;
    gpu::Instance instance = mScene.describeInstance(mesh);
    instance.customIndex = row;
    narrow(instance, solidMask);
    return place(instance, mScene.layout().bounds[mesh], relWorldFromObject);
}

bool InstanceList::add(
    const DeformedInstance& deformed, const math::vec4 (&relWorldFromObject)[3], uint32_t solidMask
) {
    if (deformed.blas == 0)
        return false;
    gpu::Instance instance = describeInstance(mScene, deformed);
    instance.customIndex = deformed.row;
    narrow(instance, solidMask);
    return place(instance, deformed.bounds, relWorldFromObject);
}

bool InstanceList::place(
    gpu::Instance instance, const math::Bounds& bounds, const math::vec4 (&relWorldFromObject)[3]
) {
    math::dmat4 matrix(1.0);
    for (int r = 0; r < 3; ++r)
        for (int column = 0; column < 4; ++column) {
            instance.worldFromObject[r][column] = relWorldFromObject[r][column];
            matrix[column][r] = double(relWorldFromObject[r][column]);
        }
    if (!extract::isDrawable(matrix))
        return false;
    const math::Bounds placed = math::transformBounds(matrix, bounds);
    add(instance, {math::vec3(placed.min), math::vec3(placed.max)});
    return true;
}

void InstanceList::add(const gpu::Instance& instance, const extract::Box& box) {
    mInstances.push_back(instance);
    mBoxes.push_back(box);
}

std::vector<gpu::Instance> InstanceList::order() const {
    std::vector<gpu::Instance> ordered;
    ordered.reserve(mInstances.size());
    for (const uint32_t index : computeOrder())
        ordered.push_back(mInstances[index]);
    return ordered;
}

} // namespace shutter::rays
