// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_overlay.h"

#include "spirv/motion_blur/overlay.comp.h"
#include "spirv/motion_blur/overlay_ids.comp.h"

#include "engine/math/layer_tables.h"
#include "modules/motion_blur/embedding/host_input_check.h"
#include "modules/motion_blur/embedding/host_ways.h"
#include "modules/motion_blur/embedding/pixel_pass.h"
#include "shaders/motion_blur/prepare.glsl"

#include <cmath>

namespace shutter::motion_blur {

namespace {

using math::dmat4;

struct Push {
    glm::uvec2 sizePx;
    glm::uvec2 table;
};

struct OverlayIdsPush {
    glm::uvec2 sizePx;
};

uint32_t bitOf(uint32_t panel) {
    return 1u << panel;
}

/// Side of the world's cells: a metre, or what is as far from the camera in a host's own unit of
/// length, which the near plane shows.
double chooseCell(const HostDepth& depth, const shader::PrepareTable& table) {
    if (depth.isLinear)
        return 1.0;
    const float nearest = shader::metresOfDepth(table, depth.skyValue == 0.0f ? 1.0f : 0.0f);
    if (nearest >= shader::kSkyDepth)
        return 1.0;
    return std::pow(10.0, std::round(std::log10(10.0 * double(nearest))));
}

/// Rows of the map from picture space to the world in cells, whose origin is moved to within two of
/// the camera: floats keep cells apart then wherever in the world the camera is.
void setWorld(const HostInputs& inputs, shader::OverlayTable& table) {
    const double cell = chooseCell(inputs.convention.depth, table.prepare);
    const HostCameras& cameras = inputs.convention.cameras;
    const auto camera = normalize(
        HostCameraKey{0.0, cameras.viewFromWorld, cameras.clipFromView}, cameras.aheadIsPlusZ
    );
    const math::uvec2 sizePx(inputs.width, inputs.height);
    const dmat4 view = glm::inverse(camera->viewFromWorld);
    dmat4 near = view;
    for (int axis = 0; axis < 3; ++axis)
        near[3][axis] = view[3][axis] - 2.0 * cell * std::floor(view[3][axis] / (2.0 * cell));
    const dmat4 world =
        near * glm::inverse(math::pictureFromView(camera->clipFromView, sizePx, cameras.jitterPx));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            table.worldFromPicture[row][column] = float(world[column][row] / cell);
}

} // namespace

shader::OverlayTable
makeOverlayTable(const HostInputs& inputs, const MotionBlurInputs& effectInputs) {
    const HostConvention& convention = inputs.convention;
    shader::OverlayTable table{};
    table.panels = bitOf(shader::kPanelMotion) | bitOf(shader::kPanelDepth);
    if (effectInputs.entityId.isValid())
        table.panels |= bitOf(shader::kPanelIds);
    if (effectInputs.normal.isValid())
        table.panels |= bitOf(shader::kPanelNormal);
    if (!convention.cameras.areGiven)
        return table;
    table.panels |=
        bitOf(shader::kPanelCamera) | bitOf(shader::kPanelWorld) | bitOf(shader::kPanelJitter);
    // The exposure of motionDepth is unknown, so the camera's part cannot be computed.
    if (!inputs.motionDepth.image)
        table.panels |= bitOf(shader::kPanelObjects);
    table.prepare = makePrepareTable(convention, pictureOf(inputs));
    table.jitterPx = glm::vec2(convention.cameras.jitterPx);
    setWorld(inputs, table);
    return table;
}

HostOverlay::HostOverlay(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mPanels(device, describePixelPass("show inputs", motion_blur_overlay_comp, 2, sizeof(Push))),
      mIds(
          device,
          describePixelPass("show ids", motion_blur_overlay_ids_comp, 1, sizeof(OverlayIdsPush))
      ) {}

graph::ImageHandle HostOverlay::add(
    graph::Graph& graph,
    const MotionBlurInputs& effectInputs,
    graph::ImageHandle picture,
    VkDeviceAddress table
) const {
    const graph::TransientImageDesc& size = graph.describeImage(picture);
    const glm::uvec2 sizePx(size.width, size.height);
    // Something has to be bound for normals that are not there; no panel reads it.
    const graph::ImageHandle normal =
        effectInputs.normal.isValid() ? effectInputs.normal : effectInputs.motionDepth;
    picture = addPixelPass(
        graph,
        mPanels,
        "show inputs",
        {effectInputs.motionDepth, normal},
        picture,
        Push{sizePx, gpu::splitAddress(table)},
        mSampler
    );
    if (!effectInputs.entityId.isValid())
        return picture;
    return addPixelPass(
        graph, mIds, "show ids", {effectInputs.entityId}, picture, OverlayIdsPush{sizePx}, mSampler
    );
}

} // namespace shutter::motion_blur
