// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_preparation.h"

#include "spirv/motion_blur/deliver_float.comp.h"
#include "spirv/motion_blur/deliver_half.comp.h"
#include "spirv/motion_blur/deliver_packed.comp.h"
#include "spirv/motion_blur/prepare_ids.comp.h"
#include "spirv/motion_blur/prepare_image.comp.h"
#include "spirv/motion_blur/prepare_motion.comp.h"
#include "spirv/motion_blur/prepare_ways.comp.h"
#include "spirv/motion_blur/prepare_world.comp.h"

#include "engine/core/check.h"
#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/embedding/pixel_pass.h"

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

struct DeliverPush {
    glm::uvec2 sizePx;
    glm::ivec2 offset;
};

glm::uvec2 sizeOf(VkExtent2D extent) {
    return {extent.width, extent.height};
}

graph::ImageHandle
createPicture(graph::Graph& graph, const char* name, VkFormat format, VkExtent2D picture) {
    return graph.createImage(name, {picture.width, picture.height, format});
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
        PrepareImagePush{sizeOf(picture), makeArea(given, picture)},
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
        PrepareImagePush{sizeOf(picture), makeArea(given, picture)},
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
