// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_preparation.h"

#include "spirv/motion_blur/deliver_float.comp.h"
#include "spirv/motion_blur/deliver_half.comp.h"
#include "spirv/motion_blur/deliver_packed.comp.h"
#include "spirv/motion_blur/prepare_ids.comp.h"
#include "spirv/motion_blur/prepare_image.comp.h"
#include "spirv/motion_blur/prepare_motion.comp.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/execute.h"
#include "modules/motion_blur/passes/dispatch.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter::motion_blur {

namespace {

using graph::Access;

// Push constants, as the shaders declare them.
struct MotionPush {
    glm::uvec2 sizePx;
    glm::uvec2 table;
};

struct ImagePush {
    glm::uvec2 sizePx;
    shader::PrepareArea area;
};

struct IdsPush {
    glm::uvec2 sizePx;
    shader::PrepareArea area;
    uint32_t noneValue;
};

struct DeliverPush {
    glm::uvec2 sizePx;
    glm::ivec2 offset;
};

gpu::ComputePipelineDesc describe(
    const char* name,
    std::span<const uint32_t> spirv,
    uint32_t sampledCount,
    uint32_t pushConstantBytes,
    std::vector<uint32_t> specialization = {}
) {
    gpu::ComputePipelineDesc desc;
    desc.name = name;
    desc.spirv = spirv;
    desc.interface.bindings.assign(sampledCount, kSampled);
    desc.interface.bindings.push_back(kStorage);
    desc.interface.pushConstantBytes = pushConstantBytes;
    desc.specialization = std::move(specialization);
    return desc;
}

glm::uvec2 sizeOf(VkExtent2D extent) {
    return {extent.width, extent.height};
}

/// Declares a pass of one thread a pixel that samples `sources` and writes `target`.
template <class Push>
graph::ImageHandle addPixelPass(
    graph::Graph& graph,
    const gpu::LazyPipeline& pipeline,
    const char* name,
    const std::vector<graph::ImageHandle>& sources,
    graph::ImageHandle target,
    const Push& push,
    VkSampler sampler
) {
    struct Data {
        std::vector<graph::ImageHandle> sources;
        graph::ImageHandle target;
    };

    return graph
        .addPass<Data>(
            name,
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                for (const graph::ImageHandle source : sources)
                    data.sources.push_back(builder.read(source, Access::SampledCompute));
                data.target = builder.write(target, Access::StorageWrite);
            },
            [&pipeline, push, sampler](const Data& data, graph::PassContext& context) {
                gpu::BindingList bindings;
                for (const graph::ImageHandle source : data.sources)
                    bindings.sampled(context.resources.view(source), sampler);
                bindings.storage(context.resources.image(data.target));
                context.frame.bind(pipeline.get(), bindings, &push, sizeof(push));
                const glm::uvec2 groups =
                    (push.sizePx + shader::kGroupSize - 1u) / shader::kGroupSize;
                vkCmdDispatch(context.commands, groups.x, groups.y, 1);
            }
        )
        .target;
}

graph::ImageHandle
createPicture(graph::Graph& graph, const char* name, VkFormat format, VkExtent2D picture) {
    return graph.createImage(name, {picture.width, picture.height, format});
}

} // namespace

HostPreparation::HostPreparation(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mMotion(
          device, describe("prepare motion", motion_blur_prepare_motion_comp, 3, sizeof(MotionPush))
      ),
      mColor(
          device,
          describe("prepare colour", motion_blur_prepare_image_comp, 1, sizeof(ImagePush), {1})
      ),
      mNormal(
          device,
          describe("prepare normals", motion_blur_prepare_image_comp, 1, sizeof(ImagePush), {0})
      ),
      mIds(device, describe("prepare ids", motion_blur_prepare_ids_comp, 1, sizeof(IdsPush))),
      mDeliverHalf(
          device, describe("deliver", motion_blur_deliver_half_comp, 1, sizeof(DeliverPush))
      ),
      mDeliverFloat(
          device, describe("deliver", motion_blur_deliver_float_comp, 1, sizeof(DeliverPush))
      ),
      mDeliverPacked(
          device, describe("deliver", motion_blur_deliver_packed_comp, 1, sizeof(DeliverPush))
      ) {}

graph::ImageHandle HostPreparation::addMotionDepth(
    graph::Graph& graph,
    graph::ImageHandle vectors,
    graph::ImageHandle depth,
    graph::ImageHandle blurScale,
    VkDeviceAddress table,
    VkExtent2D picture
) const {
    return addPixelPass(
        graph,
        mMotion,
        "prepare motion",
        {vectors.isValid() ? vectors : depth, depth, blurScale.isValid() ? blurScale : depth},
        createPicture(graph, "motion and depth", VK_FORMAT_R32G32B32A32_SFLOAT, picture),
        MotionPush{sizeOf(picture), gpu::splitAddress(table)},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addColor(
    graph::Graph& graph, graph::ImageHandle image, const HostImage& given, VkExtent2D picture
) const {
    return addPixelPass(
        graph,
        mColor,
        "prepare colour",
        {image},
        createPicture(graph, "prepared colour", VK_FORMAT_R16G16B16A16_SFLOAT, picture),
        ImagePush{sizeOf(picture), makeArea(given, picture)},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addNormal(
    graph::Graph& graph, graph::ImageHandle image, const HostImage& given, VkExtent2D picture
) const {
    return addPixelPass(
        graph,
        mNormal,
        "prepare normals",
        {image},
        createPicture(graph, "prepared normals", VK_FORMAT_R16G16B16A16_SFLOAT, picture),
        ImagePush{sizeOf(picture), makeArea(given, picture)},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addIds(
    graph::Graph& graph,
    graph::ImageHandle image,
    const HostImage& given,
    uint32_t noneValue,
    VkExtent2D picture
) const {
    return addPixelPass(
        graph,
        mIds,
        "prepare ids",
        {image},
        createPicture(graph, "prepared ids", VK_FORMAT_R32_UINT, picture),
        IdsPush{sizeOf(picture), makeArea(given, picture), noneValue},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addDelivery(
    graph::Graph& graph,
    graph::ImageHandle picture,
    graph::ImageHandle image,
    VkFormat format,
    VkOffset2D offset
) const {
    const graph::TransientImageDesc& size = graph.describeImage(picture);
    const gpu::LazyPipeline& pipeline = format == VK_FORMAT_R16G16B16A16_SFLOAT   ? mDeliverHalf
                                        : format == VK_FORMAT_R32G32B32A32_SFLOAT ? mDeliverFloat
                                                                                  : mDeliverPacked;
    return addPixelPass(
        graph,
        pipeline,
        "deliver",
        {picture},
        image,
        DeliverPush{{size.width, size.height}, {offset.x, offset.y}},
        mSampler
    );
}

} // namespace shutter::motion_blur
