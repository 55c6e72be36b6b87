// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_image.h"

#include "engine/gpu/memory.h"
#include "engine/gpu/vulkan.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace shutter::motion_blur {

namespace {

using core::makeError;

constexpr std::array<std::pair<VkImageUsageFlags, const char*>, 4> kUsages{
    {{VK_IMAGE_USAGE_SAMPLED_BIT, "SAMPLED"},
     {VK_IMAGE_USAGE_STORAGE_BIT, "STORAGE"},
     {VK_IMAGE_USAGE_TRANSFER_SRC_BIT, "TRANSFER_SRC"},
     {VK_IMAGE_USAGE_TRANSFER_DST_BIT, "TRANSFER_DST"}}};

bool hasExtent(const HostImage& image) {
    return image.extent.width != 0 && image.extent.height != 0;
}

bool hasArea(const HostImage& image) {
    return image.area.extent.width != 0 || image.area.extent.height != 0;
}

std::string listFormats(std::span<const VkFormat> formats) {
    std::string list;
    for (const VkFormat format : formats)
        list += (list.empty() ? "" : ", ") + gpu::nameFormat(format);
    return list;
}

core::Status checkFormat(const HostImage& image, const HostImageRule& rule) {
    const VkFormat format = formatOf(image, rule);
    if (std::find(rule.formats.begin(), rule.formats.end(), format) != rule.formats.end())
        return {};
    return makeError(
        "motion blur: {}.format is {}, it must be one of {}",
        rule.name,
        gpu::nameFormat(format),
        listFormats(rule.formats)
    );
}

core::Status checkUsage(const HostImage& image, const HostImageRule& rule) {
    if (image.usage == 0)
        return {};
    for (const auto& [bit, name] : kUsages)
        if ((rule.usage & bit) != 0 && (image.usage & bit) == 0)
            return makeError(
                "motion blur: {}.usage lacks VK_IMAGE_USAGE_{}_BIT, which the image needs",
                rule.name,
                name
            );
    return {};
}

core::Status checkArea(const HostImage& image, const HostImageRule& rule, VkExtent2D picture) {
    const VkRect2D area = areaOf(image, picture);
    const VkExtent2D extent = extentOf(image, picture);
    if ((image.area.extent.width == 0) != (image.area.extent.height == 0))
        return makeError(
            "motion blur: {}.area.extent is {} x {}, both must be 0 or neither",
            rule.name,
            image.area.extent.width,
            image.area.extent.height
        );
    if (area.offset.x < 0 || area.offset.y < 0)
        return makeError(
            "motion blur: {}.area.offset is {}, {}, it must not be negative",
            rule.name,
            area.offset.x,
            area.offset.y
        );
    if (area.extent.width == 0 || area.extent.height == 0)
        return makeError(
            "motion blur: {}.area begins at {}, {}, beyond its extent of {} x {}",
            rule.name,
            area.offset.x,
            area.offset.y,
            extent.width,
            extent.height
        );
    if (uint64_t(area.offset.x) + area.extent.width > extent.width ||
        uint64_t(area.offset.y) + area.extent.height > extent.height)
        return makeError(
            "motion blur: {}.area ends at {}, {}, beyond its extent of {} x {}",
            rule.name,
            uint64_t(area.offset.x) + area.extent.width,
            uint64_t(area.offset.y) + area.extent.height,
            extent.width,
            extent.height
        );
    if (rule.hasPictureSize &&
        (area.extent.width != picture.width || area.extent.height != picture.height))
        return makeError(
            "motion blur: {}.{} is {} x {}{}, it must be the picture's {} x {}",
            rule.name,
            hasArea(image) ? "area.extent" : "extent",
            area.extent.width,
            area.extent.height,
            hasArea(image) ? "" : ", all of which is used without an area",
            picture.width,
            picture.height
        );
    return {};
}

/// Checks that the device supports the input's usage for images of the format.
core::Status
checkSupport(VkPhysicalDevice device, const HostImage& image, const HostImageRule& rule) {
    const VkFormat format = formatOf(image, rule);
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device, format, &properties);
    const auto lacks = [&](VkImageUsageFlags usage, VkFormatFeatureFlags feature) {
        return (rule.usage & usage) != 0 && (properties.optimalTilingFeatures & feature) == 0;
    };
    const bool lacksStorage =
        lacks(VK_IMAGE_USAGE_STORAGE_BIT, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
    if (lacksStorage || lacks(VK_IMAGE_USAGE_SAMPLED_BIT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
        return makeError(
            "motion blur: {}.format is {}, of which the device has no {} images",
            rule.name,
            gpu::nameFormat(format),
            lacksStorage ? "storage" : "sampled"
        );
    return {};
}

} // namespace

VkFormat formatOf(const HostImage& image, const HostImageRule& rule) {
    return image.format == VK_FORMAT_UNDEFINED ? rule.formats.front() : image.format;
}

VkRect2D areaOf(const HostImage& image, VkExtent2D picture) {
    if (hasArea(image) || !hasExtent(image))
        return {image.area.offset, hasArea(image) ? image.area.extent : picture};
    const auto rest = [](uint32_t side, int32_t offset) {
        return side - std::min(side, uint32_t(std::max(offset, 0)));
    };
    return {
        image.area.offset,
        {rest(image.extent.width, image.area.offset.x),
         rest(image.extent.height, image.area.offset.y)}};
}

VkExtent2D extentOf(const HostImage& image, VkExtent2D picture) {
    if (hasExtent(image))
        return image.extent;
    const VkRect2D area = areaOf(image, picture);
    return {
        uint32_t(std::max(area.offset.x, 0)) + area.extent.width,
        uint32_t(std::max(area.offset.y, 0)) + area.extent.height};
}

bool isWhole(const HostImage& image, VkExtent2D picture) {
    const VkRect2D area = areaOf(image, picture);
    const VkExtent2D extent = extentOf(image, picture);
    return area.offset.x == 0 && area.offset.y == 0 && area.extent.width == picture.width &&
           area.extent.height == picture.height && extent.width == picture.width &&
           extent.height == picture.height;
}

core::Status checkImage(const HostImage& image, const HostImageRule& rule, VkExtent2D picture) {
    if (!image.image)
        return makeError("motion blur: {}.image is null", rule.name);
    if (!rule.isWritten && image.before.layout == VK_IMAGE_LAYOUT_UNDEFINED)
        return makeError(
            "motion blur: {}.before.layout is undefined, its contents are lost", rule.name
        );
    SHUTTER_TRY(checkFormat(image, rule));
    if (image.samples != 0 && image.samples != VK_SAMPLE_COUNT_1_BIT)
        return makeError(
            "motion blur: {}.samples is {}, it must be 1: resolve the image first{}",
            rule.name,
            uint32_t(image.samples),
            rule.isDepth
                ? ", depth by VK_RESOLVE_MODE_SAMPLE_ZERO_BIT or a shader that reads sample "
                  "0: a mean of depths is of no surface"
                : ""
        );
    SHUTTER_TRY(checkUsage(image, rule));
    return checkArea(image, rule, picture);
}

uint64_t leastBytes(VkExtent2D extent, VkFormat format) {
    uint64_t bytes = 0;
    switch (format) { // depth and stencil may be apart
    case VK_FORMAT_D16_UNORM_S8_UINT:
        bytes = 3;
        break;
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        bytes = 4;
        break;
    default:
        bytes = gpu::texelBytes(format);
    }
    return bytes * extent.width * extent.height;
}

core::Status checkDevice(
    const ImageLimits& limits, const HostImage& image, const HostImageRule& rule, VkExtent2D picture
) {
    SHUTTER_TRY(checkSupport(limits.physical, image, rule));
    const VkExtent2D extent = extentOf(image, picture);
    if (extent.width > limits.mostPixels || extent.height > limits.mostPixels)
        return makeError(
            "motion blur: {}.extent is {} x {}, the device's images are at most {} wide and "
            "high",
            rule.name,
            extent.width,
            extent.height,
            limits.mostPixels
        );
    if (!limits.device)
        return {};
    VkMemoryRequirements taken{};
    vkGetImageMemoryRequirements(limits.device, image.image, &taken);
    const VkFormat format = formatOf(image, rule);
    const uint64_t least = leastBytes(extent, format);
    if (taken.size < least)
        return makeError(
            "motion blur: {} takes {} bytes, but {} x {} pixels of {} take {} or more: the image "
            "is smaller than declared, or has another format",
            rule.name,
            taken.size,
            extent.width,
            extent.height,
            gpu::nameFormat(format),
            least
        );
    return {};
}

} // namespace shutter::motion_blur
