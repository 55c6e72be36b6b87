// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_plan.h"

#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/embedding/host_input_check.h"

#include <algorithm>

namespace shutter::motion_blur {

namespace {

/// A handle that no function of Vulkan may get; each call has another one.
VkImage placeholderImage(uintptr_t& next) {
    return reinterpret_cast<VkImage>(++next);
}

void fillPlaceholderMotion(const HostPlan& plan, DryRunInputs& dryRun) {
    glm::dmat4 clipFromView(0.0); // perspective, reversed, infinitely far
    clipFromView[0][0] = clipFromView[1][1] = 1.0;
    clipFromView[2][3] = -1.0;
    clipFromView[3][2] = 0.1;
    const glm::dmat4 unit(1.0);
    glm::dmat4 moved(1.0);
    moved[3] = glm::dvec4(1.0, 0.0, 0.0, 1.0);
    dryRun.keys = {{0.0, unit, clipFromView}, {1.0, moved, clipFromView}};
    dryRun.matrices = {unit, moved};
    dryRun.movers.clear();
    for (uint32_t row = 0; row < std::min(plan.moverCount, plan.rowCount); ++row)
        dryRun.movers.push_back({row, dryRun.matrices});
    HostMotion& motion = dryRun.inputs.motion;
    motion.keys = dryRun.keys;
    motion.movers = dryRun.movers;
    motion.rowCount = plan.rowCount;
    motion.followsLast = true;
    motion.lens.radius = plan.hasLens ? 0.01 : 0.0;
}

/// As many whole rows as hold the planned pixels.
void imagineDrawn(const HostPlan& plan, HostBlended& drawn) {
    drawn.record = [](const BlendedTask&) {};
    const uint64_t width = std::max(plan.width, 1u);
    const uint64_t rows = (plan.blendedPixels + width - 1) / width;
    drawn.area.extent = {plan.width, uint32_t(std::min<uint64_t>(rows, plan.height))};
    drawn.instantCount = plan.blendedInstants;
    drawn.partCount = plan.blendedParts;
    drawn.isOpacityInAlpha = plan.isBlendedOpacityInAlpha;
}

} // namespace

void DryRunInputs::moveCamera() {
    for (HostCameraKey& key : keys)
        key.viewFromWorld[3].x += 1.0;
}

void fillPlaceholders(const HostPlan& plan, DryRunInputs& dryRun) {
    uintptr_t next = 0;
    const auto make = [&](VkFormat format) {
        HostImage image;
        image.image = placeholderImage(next);
        image.before.layout = VK_IMAGE_LAYOUT_GENERAL;
        image.format = format;
        return image;
    };
    HostInputs& inputs = dryRun.inputs;
    inputs = {};
    inputs.width = plan.width;
    inputs.height = plan.height;
    inputs.color = make(plan.colorFormat);
    if (plan.outputFormat != VK_FORMAT_UNDEFINED)
        inputs.output = make(plan.outputFormat);
    if (plan.areParts)
        inputs.color.layer = inputs.output.layer = 1;
    if (plan.entityIdFormat != VK_FORMAT_UNDEFINED)
        inputs.entityId = make(plan.entityIdFormat);
    inputs.normal = make(kHostColorFormat);
    if (plan.hasVectors) {
        inputs.convention.vectors.image = make(VK_FORMAT_R16G16_SFLOAT);
        inputs.convention.depth.image = make(VK_FORMAT_R32_SFLOAT);
        inputs.convention.depth.isLinear = true;
    } else {
        inputs.motionDepth = make(kHostMotionFormat);
    }
    if (plan.lendsLast)
        inputs.last = {make(kHostColorFormat), make(kHostMotionFormat), inputs.entityId};
    if (inputs.last.entityId.image)
        inputs.last.entityId.image = placeholderImage(next);
    if (plan.givesDeformedMotion) {
        inputs.deformedMotion = make(kHostColorFormat);
        inputs.lastDeformedMotion = make(kHostColorFormat);
    }
    if (plan.blendedPixels > 0 && plan.drawsBlended)
        imagineDrawn(plan, inputs.drawn);
    else if (plan.blendedPixels > 0)
        inputs.blended = make(kHostColorFormat);
    inputs.reveal.record = [](const RevealTask&) {};
    inputs.samples.record = [](const SampleTask&) {};
    fillPlaceholderMotion(plan, dryRun);
    HostCameras& cameras = inputs.convention.cameras;
    cameras.areGiven = true;
    cameras.clipFromView = cameras.clipFromViewBefore = dryRun.keys.front().clipFromView;
}

} // namespace shutter::motion_blur
