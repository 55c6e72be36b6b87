// SPDX-License-Identifier: MIT
#include "tests/kit/graph_rig.h"

#include "engine/core/check.h"
#include "engine/gpu/upload.h"
#include "engine/graph/execute.h"
#include "engine/image/image.h"

#include <cstdint>
#include <vector>

namespace shutter::test {

GraphRig::GraphRig(gpu::Device& device)
    : mDevice(device), mFrame(device), mPool(device), mReadback(device) {
    mFrame.begin();
}

graph::ImageHandle
GraphRig::upload(const image::Image& picture, VkFormat format, std::span<const std::byte> texels) {
    gpu::ImageDesc desc;
    desc.width = picture.width;
    desc.height = picture.height;
    desc.format = format;
    desc.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_SAMPLED_BIT;
    gpu::Image& image = mUploads.emplace_back(mDevice, "uploaded", desc);
    gpu::uploadTexture(mDevice, image, texels);
    return graph.importImage(
        "uploaded", image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_UNDEFINED
    );
}

graph::ImageHandle GraphRig::upload(const image::Image& picture) {
    SHUTTER_CHECK_EQ(picture.channels, 4u);
    return upload(picture, VK_FORMAT_R32G32B32A32_SFLOAT, std::as_bytes(std::span(picture.pixels)));
}

graph::ImageHandle GraphRig::uploadColor(const image::Image& picture) {
    SHUTTER_CHECK_EQ(picture.channels, 4u);
    const std::vector<uint16_t> halves = image::packHalf(picture);
    return upload(picture, VK_FORMAT_R16G16B16A16_SFLOAT, std::as_bytes(std::span(halves)));
}

graph::ImageHandle GraphRig::uploadIds(const image::Image& ids) {
    SHUTTER_CHECK_EQ(ids.channels, 1u);
    std::vector<uint32_t> whole;
    whole.reserve(ids.pixels.size());
    for (const float id : ids.pixels)
        whole.push_back(static_cast<uint32_t>(id));
    return upload(ids, VK_FORMAT_R32_UINT, std::as_bytes(std::span(whole)));
}

size_t GraphRig::want(graph::ImageHandle image) {
    return mReadback.add(graph, "picture", image);
}

core::Result<graph::Plan> GraphRig::run() {
    auto plan = graph::execute(graph, mFrame, mPool);
    mFrame.submit();
    mFrame.wait();
    return plan;
}

} // namespace shutter::test
