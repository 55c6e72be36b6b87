// SPDX-License-Identifier: MIT
// An image of a host, as the motion blur reads or writes it.
#pragma once

#include "engine/core/result.h"
#include "engine/graph/types.h"

#include <cstdint>
#include <span>

namespace shutter::motion_blur {

/// An image of the host: 2D, one level, one sample, owned by the queue family of the command
/// buffer. It may be destroyed once the frame is done.
///
/// `format`, `area`, `extent` and `usage` may be left as they are by a host whose image has the
/// input's own format and the picture's size. What is said of `usage` and `samples` is checked;
/// Vulkan does not tell them.
struct HostImage {
    VkImage image = VK_NULL_HANDLE;
    graph::OutsideUse before; ///< the host's last use, which is waited for
    graph::OutsideUse after;  ///< the host's next use, which needs no barrier of the host's
    VkFormat format = VK_FORMAT_UNDEFINED; ///< UNDEFINED: the first that the input takes
    /// Size of the whole image, pixels; 0 x 0: it ends where the part that is used does.
    VkExtent2D extent{0, 0};
    /// The part that is used: a picture of `area.extent` from `area.offset`; an extent of 0 x 0:
    /// the picture's size. Inputs of another size than the picture's are read at the nearest pixel.
    VkRect2D area{{0, 0}, {0, 0}};
    VkImageUsageFlags usage = 0; ///< that it was made with; 0: not said
    /// Array layer that is used, e.g. one eye's; the layout of no other layer is changed.
    uint32_t layer = 0;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT; ///< that it was made with; must be 1
};

/// What one input takes, by the order of preference.
struct HostImageRule {
    const char* name; ///< as in HostInputs
    std::span<const VkFormat> formats;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT; ///< that it needs
    bool isWritten = false;                               ///< its contents before do not matter
    bool hasPictureSize = true; ///< the part that is used has the picture's size
};

/// HostImage::format, or the rule's first where that is UNDEFINED.
[[nodiscard]] VkFormat formatOf(const HostImage& image, const HostImageRule& rule);
/// HostImage::area with its size.
[[nodiscard]] VkRect2D areaOf(const HostImage& image, VkExtent2D picture);
/// HostImage::extent, or where the area ends.
[[nodiscard]] VkExtent2D extentOf(const HostImage& image, VkExtent2D picture);
/// The area is the whole image and has the picture's size.
[[nodiscard]] bool isWhole(const HostImage& image, VkExtent2D picture);

/// One sentence that names the field which is wrong.
/// \param picture size of the blurred picture
[[nodiscard]] core::Status
checkImage(const HostImage& image, const HostImageRule& rule, VkExtent2D picture);

/// Whether the device's images of the format can be what the input needs.
[[nodiscard]] core::Status
checkSupport(VkPhysicalDevice device, const HostImage& image, const HostImageRule& rule);

} // namespace shutter::motion_blur
