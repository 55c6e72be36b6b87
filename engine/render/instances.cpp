// SPDX-License-Identifier: MIT
#include "engine/render/instances.h"

#include "engine/math/bounds.h"
#include "engine/render/poses.h"

namespace shutter::render {

namespace {

void narrow(gpu::Instance& instance, uint32_t solidMask) {
    if ((instance.mask & shader::kSolidMask) != 0)
        instance.mask = (instance.mask & ~shader::kSolidMask) | solidMask;
}

} // namespace

gpu::Instance describeInstance(const GpuScene& scene, uint32_t mesh) {
    const SceneLayout& layout = scene.layout();
    gpu::Instance instance{};
    for (int i = 0; i < 3; ++i)
        instance.worldFromObject[i][i] = 1.0f;
    instance.bottomLevel = scene.bottomLevel(mesh).address();
    instance.cullDisabled = false;
    instance.mask = 0;
    for (uint32_t g = layout.firstGeometry[mesh]; g < layout.firstGeometry[mesh + 1]; ++g) {
        const SceneLayout::GeometryInfo& info = layout.geometries[g];
        instance.cullDisabled = instance.cullDisabled || info.doubleSided;
        instance.mask |=
            info.alphaMode == scene::AlphaMode::Blend ? shader::kBlendedMask : shader::kSolidMask;
    }
    return instance;
}

gpu::Instance describeInstance(const GpuScene& scene, const BentInstance& bent) {
    gpu::Instance instance = describeInstance(scene, bent.mesh);
    instance.bottomLevel = bent.bottomLevel;
    instance.flipFacing = bent.mirrored;
    return instance;
}

bool InstanceList::add(
    uint32_t row, uint32_t mesh, const math::vec4 (&eyeFromObject)[3], uint32_t solidMask
) {
    if (!mScene.bottomLevel(mesh))
        return false;
    gpu::Instance instance = describeInstance(mScene, mesh);
    instance.customIndex = row;
    narrow(instance, solidMask);
    return place(instance, mScene.layout().bounds[mesh], eyeFromObject);
}

bool InstanceList::add(
    const BentInstance& bent, const math::vec4 (&eyeFromObject)[3], uint32_t solidMask
) {
    if (bent.bottomLevel == 0)
        return false;
    gpu::Instance instance = describeInstance(mScene, bent);
    instance.customIndex = bent.row;
    narrow(instance, solidMask);
    return place(instance, bent.bounds, eyeFromObject);
}

bool InstanceList::place(
    gpu::Instance instance, const math::Bounds& bounds, const math::vec4 (&eyeFromObject)[3]
) {
    math::dmat4 matrix(1.0);
    for (int r = 0; r < 3; ++r)
        for (int column = 0; column < 4; ++column) {
            instance.worldFromObject[r][column] = eyeFromObject[r][column];
            matrix[column][r] = double(eyeFromObject[r][column]);
        }
    if (!isDrawable(matrix))
        return false;
    const math::Bounds placed = math::transformBounds(matrix, bounds);
    add(instance, {math::vec3(placed.min), math::vec3(placed.max)});
    return true;
}

void InstanceList::add(const gpu::Instance& instance, const Box& box) {
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

} // namespace shutter::render
