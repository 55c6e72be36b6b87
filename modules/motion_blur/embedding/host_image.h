// SPDX-License-Identifier: MIT
// An image of a host, as the motion blur reads or writes it.
#pragma once

#include "engine/core/result.h"
#include "engine/graph/types.h"

#include <cstdint>
#include <span>

namespace shutter::motion_blur {

/// ShutterBlurImage. Uses of no stages are all commands there, and OutsideUse{} here.
struct HostImage {
    VkImage image = VK_NULL_HANDLE;
    graph::OutsideUse before; ///< the host's last use, which is waited for
    graph::OutsideUse after;  ///< the host's next use, which needs no barrier of the host's
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{0, 0};
    VkRect2D area{{0, 0}, {0, 0}};
    VkImageUsageFlags usage = 0;
    uint32_t layer = 0;
    VkSampleCountFlagBits samples{};
};

/// What one input takes, by the order of preference.
struct HostImageRule {
    const char* name; ///< as in HostInputs
    std::span<const VkFormat> formats;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT; ///< that it needs
    bool isWritten = false;                               ///< its contents before do not matter
    bool hasPictureSize = true; ///< the part that is used has the picture's size
    bool isDepth = false;
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

/// Limits that an image is checked against.
struct ImageLimits {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE; ///< null: images are handles of nothing
    uint32_t mostPixels = 0;          ///< a side: VkPhysicalDeviceLimits::maxImageDimension2D
};

/// Whether the device can have such an image, and this one's memory is large enough for one.
[[nodiscard]] core::Status checkDevice(
    const ImageLimits& limits, const HostImage& image, const HostImageRule& rule, VkExtent2D picture
);

/// Bytes that an image of that size and format takes at least.
[[nodiscard]] uint64_t leastBytes(VkExtent2D extent, VkFormat format);

} // namespace shutter::motion_blur
