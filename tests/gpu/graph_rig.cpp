// SPDX-License-Identifier: MIT
#include "tests/gpu/graph_rig.h"

#include "spirv/accumulate/accumulate.comp.h"

#include "engine/core/check.h"
#include "engine/gpu/upload.h"
#include "engine/graph/execute.h"
#include "engine/image/image.h"
#include "shaders/accumulate/accumulate_shared.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace shutter::test {

GraphRig::GraphRig(gpu::Device& device)
    : mDevice(device), mFrame(device), mPool(device), mReadback(device) {
    mFrame.begin();
}

graph::ImageHandle
GraphRig::upload(const image::Image& picture, VkFormat format, std::span<const std::byte> texels) {
    SHUTTER_CHECK_EQ(picture.channels, 4u);
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
    return upload(picture, VK_FORMAT_R32G32B32A32_SFLOAT, std::as_bytes(std::span(picture.pixels)));
}

graph::ImageHandle GraphRig::uploadColor(const image::Image& picture) {
    const std::vector<uint16_t> halves = image::packHalf(picture);
    return upload(picture, VK_FORMAT_R16G16B16A16_SFLOAT, std::as_bytes(std::span(halves)));
}

size_t GraphRig::want(graph::ImageHandle image) {
    return mReadback.add(graph, "picture", image);
}

graph::Plan GraphRig::run() {
    auto plan = graph::execute(graph, mFrame, mPool);
    mFrame.submit();
    mFrame.wait();
    if (plan)
        return std::move(plan).value();
    ADD_FAILURE() << plan.error().message;
    return {};
}

EffectRig::EffectRig(GraphRig& rig, graph::ImageHandle color, uint32_t width, uint32_t height)
    : context{
          rig.graph, facts, gbuffer, nullptr, nullptr, color, {}, intermediates, 0, 0, explainer} {
    facts.width = width;
    facts.height = height;
    facts.displayWanted = true;
}

gpu::Pipeline makeScalePipeline(gpu::Device& device) {
    gpu::ComputePipelineDesc desc;
    desc.name = "scale";
    desc.spirv = accumulate_accumulate_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::AccumulateParams);
    return gpu::Pipeline(device, desc);
}

} // namespace shutter::test
