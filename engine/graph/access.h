// SPDX-License-Identifier: MIT
// What Vulkan wants to know of each way to touch a resource, in one table.
#pragma once

#include "engine/graph/types.h"

namespace shutter::graph {

struct AccessScope {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 reads = 0;
    VkAccessFlags2 writes = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED; ///< images only
};

[[nodiscard]] AccessScope scopeOf(Access access, PassKind kind);
[[nodiscard]] bool fitsImage(Access access);
[[nodiscard]] bool fitsBuffer(Access access);
[[nodiscard]] bool fitsPass(Access access, PassKind kind);
/// Usage flag that an image or buffer needs for the access; 0 where the creator has to know.
[[nodiscard]] VkImageUsageFlags imageUsageOf(Access access);
[[nodiscard]] VkBufferUsageFlags bufferUsageOf(Access access);

} // namespace shutter::graph
