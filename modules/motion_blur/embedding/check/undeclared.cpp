// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/check/checker.h"
#include "modules/motion_blur/embedding/host_input_check.h"
#include "modules/motion_blur/embedding/host_inputs.h"

#include <fmt/format.h>

#include <array>
#include <string>

namespace shutter::motion_blur {

namespace {

struct Named {
    const HostImage& image;
    HostImageRule rule;
};

std::array<Named, 12> listImages(const HostInputs& inputs) {
    const HostConvention& convention = inputs.convention;
    return {
        {{inputs.color, colorRule(inputs)},
         {inputs.output, outputRule(inputs)},
         {inputs.motionDepth, kMotionRule},
         {convention.vectors.image, kVectorsRule},
         {convention.depth.image, kDepthRule},
         {convention.scales.perPixel, kBlurScaleRule},
         {inputs.entityId, kIdRule},
         {inputs.normal, kNormalRule},
         {inputs.last.color, kLastColorRule},
         {inputs.last.motionDepth, kLastMotionRule},
         {inputs.last.entityId, kLastIdRule},
         {inputs.blended, kBlendedRule}}};
}

void append(std::string& list, const char* name) {
    list += (list.empty() ? "" : ", ") + std::string(name);
}

/// Ratio of an image's memory to that of an image as declared.
double measureMemory(VkDevice device, const Named& named, VkExtent2D picture) {
    VkMemoryRequirements taken{};
    vkGetImageMemoryRequirements(device, named.image.image, &taken);
    const VkExtent2D extent = extentOf(named.image, picture);
    return double(taken.size) / double(leastBytes(extent, formatOf(named.image, named.rule)));
}

} // namespace

void HostUndeclared::report(const HostInputs& inputs, const HostMessage& message) {
    if (!message)
        return;
    const auto images = listImages(inputs);
    const VkExtent2D picture = pictureOf(inputs);
    std::string extents;
    for (uint32_t i = 0; i < images.size(); ++i) {
        const Named& named = images[i];
        const uint32_t bit = 1u << i;
        if (!named.image.image)
            continue;
        // Padding and a chain of mip levels are less than that.
        constexpr double kMaxTimes = 1.8;
        constexpr uint64_t kMinPixels = 128 * 128; // padding counts for much of a smaller one
        const bool isLarge = uint64_t(picture.width) * picture.height >= kMinPixels;
        if (isLarge && (mReported & bit) == 0 && named.image.extent.width == 0 &&
            measureMemory(mDevice, named, picture) > kMaxTimes) {
            append(extents, named.rule.name);
            mReported |= bit;
        }
    }
    if (!extents.empty())
        message(fmt::format(
            "motion blur check: the extent of {} is not declared, and the image's memory is that "
            "of a much larger one than {} x {}: set its size there, and the area of it that is "
            "used",
            extents,
            picture.width,
            picture.height
        ));
}

} // namespace shutter::motion_blur
