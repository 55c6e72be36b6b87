// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_blended.h"

#include "modules/motion_blur/embedding/host_instants.h"
#include "modules/motion_blur/passes/instant_surfaces.h"

#include <algorithm>

namespace shutter::motion_blur {

namespace {

using core::makeError;

constexpr uint32_t kMaxInstants = 256;
constexpr uint32_t kFilterInstants = 15; ///< where the host wants the default

uint32_t countDrawn(const HostInputs& inputs, const MotionBlurSettings& settings) {
    if (inputs.isOff)
        return 1;
    const uint32_t wanted = inputs.drawn.instantCount;
    if (!findsSurfaces(inputs, settings))
        return wanted == 0 ? kFilterInstants : wanted;
    return wanted == 0 ? settings.sampleCount : std::min(wanted, settings.sampleCount);
}

shader::InstantSurfaces
describeRectangle(const HostInputs& inputs, const MotionBlurSettings& settings) {
    const HostBlended& drawn = inputs.drawn;
    shader::InstantSurfaces head{};
    head.sizePx = {inputs.width, inputs.height};
    if (drawn.area.extent.width > 0) {
        head.originPx = {uint32_t(drawn.area.offset.x), uint32_t(drawn.area.offset.y)};
        head.sizePx = {drawn.area.extent.width, drawn.area.extent.height};
    }
    head.instantCount = countDrawn(inputs, settings);
    const uint32_t parts = drawn.partCount == 0 ? shader::kMaxSurfaceParts : drawn.partCount;
    head.partCount = findsSurfaces(inputs, settings) ? std::min(parts, head.instantCount) : 1;
    return head;
}

core::Status checkArea(const HostInputs& inputs) {
    const VkRect2D& area = inputs.drawn.area;
    const auto fits = [](int32_t offset, uint32_t extent, uint32_t size) {
        return offset >= 0 && extent > 0 && uint64_t(offset) + extent <= size;
    };
    if (area.extent.width == 0 && area.extent.height == 0)
        return {};
    if (fits(area.offset.x, area.extent.width, inputs.width) &&
        fits(area.offset.y, area.extent.height, inputs.height))
        return {};
    return makeError(
        "motion blur: blendedArea is {} x {} at {}, {}, outside of the picture of {} x {}",
        area.extent.width,
        area.extent.height,
        area.offset.x,
        area.offset.y,
        inputs.width,
        inputs.height
    );
}

} // namespace

bool findsSurfaces(const HostInputs& inputs, const MotionBlurSettings& settings) {
    return !inputs.isOff && settings.method->readsInstantMotions;
}

BlendedDraws describeDrawn(
    const HostInputs& inputs,
    const MotionBlurSettings& settings,
    const shader::ResponseTable* response
) {
    BlendedDraws draws;
    draws.rectangle = describeRectangle(inputs, settings);
    const uint32_t count = draws.rectangle.instantCount;
    for (uint32_t i = 0; i < count; ++i)
        draws.times.push_back(
            inputs.isOff ? inputs.rasterTime : invertResponse(response, (i + 0.5) / count)
        );
    return draws;
}

core::Status checkDrawn(
    const HostInputs& inputs, const MotionBlurSettings& settings, VkDeviceSize mostBufferBytes
) {
    const HostBlended& drawn = inputs.drawn;
    if (!drawn.record)
        return {};
    if (drawn.instantCount > kMaxInstants)
        return makeError(
            "motion blur: blendedInstants is {}, it must be 0 to {}",
            drawn.instantCount,
            kMaxInstants
        );
    if (drawn.partCount > shader::kMaxSurfaceParts)
        return makeError(
            "motion blur: blendedParts is {}, it must be 0 to {}",
            drawn.partCount,
            shader::kMaxSurfaceParts
        );
    SHUTTER_TRY(checkArea(inputs));
    if (!findsSurfaces(inputs, settings))
        return {};
    const shader::InstantSurfaces head = describeRectangle(inputs, settings);
    const VkDeviceSize bytes = surfaceBytes(head);
    if (bytes > mostBufferBytes)
        return makeError(
            "motion blur: blendedArea of {} x {} with {} instants takes a buffer of {} bytes, the "
            "device has at most {}; give a smaller one, or fewer blendedInstants",
            head.sizePx.x,
            head.sizePx.y,
            head.instantCount,
            bytes,
            mostBufferBytes
        );
    return {};
}

} // namespace shutter::motion_blur
