// SPDX-License-Identifier: MIT
#include "tests/conformance/stability/gbuffer_rig.h"

#include "engine/core/check.h"
#include "engine/gpu/upload.h"
#include "engine/graph/execute.h"
#include "engine/image/image.h"
#include "game/shot/methods.h"

#include <optional>
#include <vector>

namespace shutter::stability {

using image::Image;
using motion_blur::Method;

GBufferRig::GBufferRig(gpu::Device& device)
    : mDevice(device), mFrame(device), mPool(device), mReadback(device) {
    mFrame.begin();
}

graph::ImageHandle
GBufferRig::upload(const Image& picture, VkFormat format, std::span<const std::byte> texels) {
    gpu::ImageDesc desc;
    desc.width = picture.width;
    desc.height = picture.height;
    desc.format = format;
    desc.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_SAMPLED_BIT;
    gpu::Image& image = mUploads.emplace_back(mDevice, "synthetic", desc);
    gpu::uploadTexture(mDevice, image, texels);
    return graph.importImage(
        "synthetic", image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_UNDEFINED
    );
}

graph::ImageHandle GBufferRig::upload(const Image& picture) {
    SHUTTER_CHECK_EQ(picture.channels, 4u);
    return upload(picture, VK_FORMAT_R32G32B32A32_SFLOAT, std::as_bytes(std::span(picture.pixels)));
}

graph::ImageHandle GBufferRig::uploadColor(const Image& picture) {
    SHUTTER_CHECK_EQ(picture.channels, 4u);
    const std::vector<uint16_t> halves = image::packHalf(picture);
    return upload(picture, VK_FORMAT_R16G16B16A16_SFLOAT, std::as_bytes(std::span(halves)));
}

graph::ImageHandle GBufferRig::uploadIds(const Image& ids) {
    SHUTTER_CHECK_EQ(ids.channels, 1u);
    std::vector<uint32_t> whole;
    whole.reserve(ids.pixels.size());
    for (const float id : ids.pixels)
        whole.push_back(static_cast<uint32_t>(id));
    return upload(ids, VK_FORMAT_R32_UINT, std::as_bytes(std::span(whole)));
}

size_t GBufferRig::want(graph::ImageHandle image) {
    return mReadback.add(graph, "picture", image);
}

core::Status GBufferRig::run() {
    auto plan = graph::execute(graph, mFrame, mPool);
    mFrame.submit();
    mFrame.wait();
    if (!plan)
        return plan.error();
    return {};
}

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
        if (!method->readsCamera && method->rays == motion_blur::RayNeed::None)
            filters.push_back(method);
    return filters;
}

core::Result<Blurred> FilterRig::blur(
    const GBuffer& gbuffer, const motion_blur::MotionBlurSettings& settings, double rasterTime
) {
    GBufferRig rig(mDevice);
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
    if (core::Status ran = rig.run(); !ran)
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
