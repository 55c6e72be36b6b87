// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_preparation.h"

#include "spirv/motion_blur/deliver_float.comp.h"
#include "spirv/motion_blur/deliver_half.comp.h"
#include "spirv/motion_blur/deliver_packed.comp.h"
#include "spirv/motion_blur/deliver_words.comp.h"
#include "spirv/motion_blur/prepare_ids.comp.h"
#include "spirv/motion_blur/prepare_image.comp.h"
#include "spirv/motion_blur/prepare_motion.comp.h"
#include "spirv/motion_blur/prepare_view_model.comp.h"
#include "spirv/motion_blur/prepare_ways.comp.h"
#include "spirv/motion_blur/prepare_world.comp.h"

#include "engine/core/check.h"
#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/embedding/pixel_pass.h"
#include "shaders/motion_blur/deliver_shared.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter::motion_blur {

namespace {

// Push constants, as the shaders declare them.
struct MotionPush {
    glm::uvec2 sizePx;
    glm::uvec2 table;
};

struct PrepareImagePush {
    glm::uvec2 sizePx;
    shader::PrepareArea area;
    shader::Transfer transfer;
};

struct PrepareIdsPush {
    glm::uvec2 sizePx;
    shader::PrepareArea area;
    uint32_t noneValue;
};

struct PrepareWorldPush {
    glm::uvec2 sizePx;
};

struct PrepareWaysPush {
    glm::uvec2 sizePx;
    shader::PrepareArea area;
    float rasterTime;
};

struct ViewModelPush {
    glm::uvec2 sizePx;
    glm::uvec2 table;
    uint32_t row;
};

struct DeliverPush {
    glm::uvec2 sizePx;
    glm::ivec2 offset;
    shader::Transfer transfer;
};

struct DeliverWordsPush {
    glm::uvec2 sizePx;
    glm::uvec2 target;
    shader::Transfer transfer;
    uint32_t packing;
};

/// Copies rows of texels into the part of an image from `offset` on.
void copyToImage(
    VkCommandBuffer commands,
    VkBuffer buffer,
    const gpu::Image& image,
    VkOffset2D offset,
    VkExtent2D size
) {
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, image.desc().layer, 1};
    region.imageOffset = {offset.x, offset.y, 0};
    region.imageExtent = {size.width, size.height, 1};
    vkCmdCopyBufferToImage(
        commands, buffer, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region
    );
}

glm::uvec2 sizeOf(VkExtent2D extent) {
    return {extent.width, extent.height};
}

graph::ImageHandle
createPicture(graph::Graph& graph, const char* name, VkFormat format, VkExtent2D picture) {
    return graph.createImage(name, {picture.width, picture.height, format});
}

gpu::ComputePipelineDesc describeWords() {
    gpu::ComputePipelineDesc desc;
    desc.name = "deliver";
    desc.spirv = motion_blur_deliver_words_comp;
    desc.interface.bindings = {kSampled};
    desc.interface.pushConstantBytes = sizeof(DeliverWordsPush);
    return desc;
}

} // namespace

HostPreparation::HostPreparation(gpu::Device& device)
    : mSampler(device.nearestSampler()),
      mMotion(
          device,
          describePixelPass(
              "prepare motion", motion_blur_prepare_motion_comp, 3, sizeof(MotionPush)
          )
      ),
      mColor(
          device,
          describePixelPass(
              "prepare colour", motion_blur_prepare_image_comp, 1, sizeof(PrepareImagePush), {1}
          )
      ),
      mNormal(
          device,
          describePixelPass(
              "prepare normals", motion_blur_prepare_image_comp, 1, sizeof(PrepareImagePush), {0}
          )
      ),
      mIds(
          device,
          describePixelPass("prepare ids", motion_blur_prepare_ids_comp, 1, sizeof(PrepareIdsPush))
      ),
      mWorldIds(
          device,
          describePixelPass(
              "prepare world", motion_blur_prepare_world_comp, 1, sizeof(PrepareWorldPush)
          )
      ),
      mViewModel(
          device,
          describePixelPass(
              "prepare view model", motion_blur_prepare_view_model_comp, 2, sizeof(ViewModelPush)
          )
      ),
      mWays(
          device,
          describePixelPass(
              "prepare ways", motion_blur_prepare_ways_comp, 1, sizeof(PrepareWaysPush)
          )
      ),
      mDeliverHalf(
          device,
          describePixelPass("deliver", motion_blur_deliver_half_comp, 1, sizeof(DeliverPush))
      ),
      mDeliverFloat(
          device,
          describePixelPass("deliver", motion_blur_deliver_float_comp, 1, sizeof(DeliverPush))
      ),
      mDeliverPacked(
          device,
          describePixelPass("deliver", motion_blur_deliver_packed_comp, 1, sizeof(DeliverPush))
      ),
      mDeliverWords(device, describeWords()) {}

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
    graph::Graph& graph,
    graph::ImageHandle image,
    const HostImage& given,
    const HostTransfer& transfer,
    VkExtent2D picture
) const {
    return addPixelPass(
        graph,
        mColor,
        "prepare colour",
        {image},
        createPicture(graph, "prepared colour", VK_FORMAT_R16G16B16A16_SFLOAT, picture),
        PrepareImagePush{
            sizeOf(picture), makeArea(given, picture), decodingOf(transfer, given.format)},
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
        PrepareImagePush{sizeOf(picture), makeArea(given, picture), {}},
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
        PrepareIdsPush{sizeOf(picture), makeArea(given, picture), noneValue},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addWorldIds(
    graph::Graph& graph, graph::ImageHandle motionDepth, VkExtent2D picture
) const {
    return addPixelPass(
        graph,
        mWorldIds,
        "prepare world",
        {motionDepth},
        createPicture(graph, "world ids", VK_FORMAT_R32_UINT, picture),
        PrepareWorldPush{sizeOf(picture)},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addViewModel(
    graph::Graph& graph,
    graph::ImageHandle ids,
    graph::ImageHandle depth,
    VkDeviceAddress table,
    uint32_t row,
    VkExtent2D picture
) const {
    return addPixelPass(
        graph,
        mViewModel,
        "prepare view model",
        {ids, depth},
        createPicture(graph, "ids with view model", VK_FORMAT_R32_UINT, picture),
        ViewModelPush{sizeOf(picture), gpu::splitAddress(table), row},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addWays(
    graph::Graph& graph,
    graph::ImageHandle image,
    const HostImage& given,
    float rasterTime,
    VkExtent2D picture
) const {
    return addPixelPass(
        graph,
        mWays,
        "prepare ways",
        {image},
        createPicture(graph, "ways", VK_FORMAT_R32G32_UINT, picture),
        PrepareWaysPush{sizeOf(picture), makeArea(given, picture), rasterTime},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addDelivery(
    graph::Graph& graph,
    graph::ImageHandle picture,
    graph::ImageHandle image,
    VkFormat format,
    const HostTransfer& transfer,
    VkOffset2D offset
) const {
    const shader::Transfer encoding = encodingOf(transfer, format);
    if (const auto packing = packingOf(format))
        return addCopy(graph, picture, image, encoding, *packing, offset);
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
        DeliverPush{{size.width, size.height}, {offset.x, offset.y}, encoding},
        mSampler
    );
}

graph::ImageHandle HostPreparation::addCopy(
    graph::Graph& graph,
    graph::ImageHandle picture,
    graph::ImageHandle image,
    const shader::Transfer& transfer,
    uint32_t packing,
    VkOffset2D offset
) const {
    struct Packed {
        graph::ImageHandle picture;
        graph::BufferHandle texels;
    };

    struct Copied {
        graph::BufferHandle texels;
        graph::ImageHandle image;
    };

    const graph::TransientImageDesc& desc = graph.describeImage(picture);
    const VkExtent2D size{desc.width, desc.height};
    const VkDeviceSize texelBytes = packing == shader::kPackRgba16 ? 8 : 4;
    graph::BufferHandle texels = graph.createBuffer(
        "delivered texels",
        {texelBytes * size.width * size.height,
         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT}
    );
    texels =
        graph
            .addPass<Packed>(
                "deliver",
                graph::PassKind::Compute,
                [&](graph::PassBuilder& builder, Packed& data) {
                    data.picture = builder.read(picture, graph::Access::SampledCompute);
                    data.texels = builder.write(texels, graph::Access::StorageWrite);
                },
                [this, transfer, packing, size](const Packed& data, graph::PassContext& context) {
                    gpu::BindingList bindings;
                    bindings.sampled(context.resources.view(data.picture), mSampler);
                    const DeliverWordsPush push{
                        sizeOf(size),
                        gpu::splitAddress(context.resources.address(data.texels)),
                        transfer,
                        packing};
                    context.frame.bind(mDeliverWords.get(), bindings, &push, sizeof(push));
                    const glm::uvec2 groups =
                        (push.sizePx + shader::kGroupSize - 1u) / shader::kGroupSize;
                    vkCmdDispatch(context.commands, groups.x, groups.y, 1);
                }
            )
            .texels;
    return graph
        .addPass<Copied>(
            "copy to host",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Copied& data) {
                data.texels = builder.read(texels, graph::Access::TransferRead);
                data.image = builder.write(image, graph::Access::TransferWrite);
            },
            [offset, size](const Copied& data, graph::PassContext& context) {
                copyToImage(
                    context.commands,
                    context.resources.buffer(data.texels),
                    context.resources.image(data.image),
                    offset,
                    size
                );
            }
        )
        .image;
}

} // namespace shutter::motion_blur
