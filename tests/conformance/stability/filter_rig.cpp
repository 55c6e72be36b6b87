// SPDX-License-Identifier: MIT
#include "tests/conformance/stability/filter_rig.h"

#include "engine/image/image.h"
#include "tests/kit/graph_rig.h"

#include <optional>

namespace shutter::stability {

void GBuffer::setColor(uint32_t x, uint32_t y, float r, float g, float b) {
    color.at(x, y, 0) = image::roundToHalf(r);
    color.at(x, y, 1) = image::roundToHalf(g);
    color.at(x, y, 2) = image::roundToHalf(b);
    color.at(x, y, 3) = 1.0f;
}

void GBuffer::setMotion(uint32_t x, uint32_t y, float right, float down, float depth) {
    motionDepth.at(x, y, 0) = right;
    motionDepth.at(x, y, 1) = down;
    motionDepth.at(x, y, 2) = depth;
}

std::vector<const motion_blur::Method*> listFilters() {
    std::vector<const motion_blur::Method*> filters;
    for (const motion_blur::Method* method : motion_blur::listMethods())
        if (method->readsImagesOnly())
            filters.push_back(method);
    return filters;
}

core::Result<Blurred> FilterRig::blur(
    const GBuffer& gbuffer, const motion_blur::MotionBlurSettings& settings, double rasterTime
) {
    test::GraphRig rig(mDevice);
    motion_blur::MotionBlurInputs inputs;
    inputs.color = rig.uploadColor(gbuffer.color);
    inputs.motionDepth = rig.upload(gbuffer.motionDepth);
    inputs.rasterTime = rasterTime;
    const motion_blur::MotionBlurOutputs outputs = mEffect.add(rig.graph, inputs, settings);
    const size_t color = rig.want(outputs.color);
    std::optional<size_t> tiles;
    std::optional<size_t> dominant;
    if (outputs.view("tile_max").isValid()) {
        tiles = rig.want(outputs.view("tile_max"));
        dominant = rig.want(outputs.view("tiles"));
    }
    if (const auto ran = rig.run(); !ran)
        return ran.error();
    Blurred blurred;
    blurred.color = rig.take(color);
    if (tiles) {
        blurred.tiles = rig.take(*tiles);
        blurred.dominant = rig.take(*dominant);
    }
    return blurred;
}

} // namespace shutter::stability
