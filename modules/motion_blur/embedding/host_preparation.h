// SPDX-License-Identifier: MIT
// The passes between a host's images and the motion blur: they make of an input in the host's
// format, convention and place the one that the effect reads, and put the result where the host
// wants it. An input that fits already has none.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/embedding/host_convention.h"
#include "modules/motion_blur/embedding/host_transfer.h"

#include <cstdint>

namespace shutter::motion_blur {

class HostPreparation {
  public:
    explicit HostPreparation(gpu::Device& device);

    /// RGBA32F of motion and depth. `vectors` and `blurScale` may be invalid.
    /// \param table where a shader::PrepareTable is; it stays until the GPU is done with the frame
    [[nodiscard]] graph::ImageHandle addMotionDepth(
        graph::Graph& graph,
        graph::ImageHandle vectors,
        graph::ImageHandle depth,
        graph::ImageHandle blurScale,
        VkDeviceAddress table,
        VkExtent2D picture
    ) const;

    /// RGBA16F of the part of `image` that is used, as light.
    [[nodiscard]] graph::ImageHandle addColor(
        graph::Graph& graph,
        graph::ImageHandle image,
        const HostImage& given,
        const HostTransfer& transfer,
        VkExtent2D picture
    ) const;
    /// The same for normals.
    [[nodiscard]] graph::ImageHandle addNormal(
        graph::Graph& graph, graph::ImageHandle image, const HostImage& given, VkExtent2D picture
    ) const;
    /// R32_UINT of ids. \param noneValue of the sky, in `image`
    [[nodiscard]] graph::ImageHandle addIds(
        graph::Graph& graph,
        graph::ImageHandle image,
        const HostImage& given,
        uint32_t noneValue,
        VkExtent2D picture
    ) const;
    /// R32_UINT of one id for all that is not the sky. \param motionDepth as the effect reads it
    [[nodiscard]] graph::ImageHandle
    addWorldIds(graph::Graph& graph, graph::ImageHandle motionDepth, VkExtent2D picture) const;
    /// `ids` as the effect reads them, with `row` at the pixels of HostConvention::viewModel.
    /// \param table as of addMotionDepth()
    [[nodiscard]] graph::ImageHandle addViewModel(
        graph::Graph& graph,
        graph::ImageHandle ids,
        graph::ImageHandle depth,
        VkDeviceAddress table,
        uint32_t row,
        VkExtent2D picture
    ) const;
    /// RG32UI of packWay()s (common/pixel_way.glsl) of ShutterBlurInputs::deformedMotion.
    [[nodiscard]] graph::ImageHandle addWays(
        graph::Graph& graph,
        graph::ImageHandle image,
        const HostImage& given,
        float rasterTime,
        VkExtent2D picture
    ) const;
    /// Writes the picture into the part of the host's image that is used, and returns that image.
    [[nodiscard]] graph::ImageHandle addDelivery(
        graph::Graph& graph,
        graph::ImageHandle picture,
        graph::ImageHandle image,
        VkFormat format,
        const HostTransfer& transfer,
        VkOffset2D offset
    ) const;

  private:
    /// The same for formats that are copied into, by packingOf().
    [[nodiscard]] graph::ImageHandle addCopy(
        graph::Graph& graph,
        graph::ImageHandle picture,
        graph::ImageHandle image,
        const shader::Transfer& transfer,
        uint32_t packing,
        VkOffset2D offset
    ) const;

    VkSampler mSampler;
    gpu::LazyPipeline mMotion;
    gpu::LazyPipeline mColor;
    gpu::LazyPipeline mNormal;
    gpu::LazyPipeline mIds;
    gpu::LazyPipeline mWorldIds;
    gpu::LazyPipeline mViewModel;
    gpu::LazyPipeline mWays;
    gpu::LazyPipeline mDeliverHalf;
    gpu::LazyPipeline mDeliverFloat;
    gpu::LazyPipeline mDeliverPacked;
    gpu::LazyPipeline mDeliverWords;
};

} // namespace shutter::motion_blur
