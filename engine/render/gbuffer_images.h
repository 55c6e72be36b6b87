// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/vulkan.h"
#include "engine/graph/graph.h"

namespace shutter::render {

inline constexpr VkFormat kColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kNormalFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kMotionDepthFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kEntityIdFormat = VK_FORMAT_R32_UINT;
inline constexpr VkFormat kSampleSurfaceFormat = VK_FORMAT_R32G32B32A32_UINT;
inline constexpr VkFormat kSampleNormalFormat = VK_FORMAT_R32_UINT;
inline constexpr VkFormat kEdgeSurfaceFormat = VK_FORMAT_R32G32B32A32_UINT;

/// The outputs of the raster pass. Formats are chosen for one nearest fetch per tap (lavapipe) and
/// for motion to a hundredth of a pixel.
struct GBuffer {
    graph::ImageHandle color;       ///< RGBA16F, linear HDR, at most kMaxColor
    graph::ImageHandle normal;      ///< RGBA16F, xyz unit, world axes; 0 for the background.
                                    ///< Invalid unless an effect or a picture needs it
    graph::ImageHandle motionDepth; ///< RGBA32F: motion.xy pixels open to close, depth metres along
                                    ///< the view; with edgeSurface, a bit for each sample that
                                    ///< edgeSurface covers, as a number
    graph::ImageHandle entityId;    ///< R32_UINT: row of the entity table, or kNoEntity
    /// RGBA32_UINT, where motionDepth has bits: the second surface of the pixel, which covers the
    /// samples that the one in the images above does not: bits of its depth, its row or kNoEntity,
    /// its colour as three halves (split_samples_shared.h). Invalid: one sample per pixel.
    graph::ImageHandle edgeSurface;
};

} // namespace shutter::render
