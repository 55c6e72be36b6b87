// SPDX-License-Identifier: MIT
#include "tests/gpu/checker_images.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cstring>

namespace shutter::test {

namespace {

/// What is where no picture is: 0xFF is NaN in floats, and an id that is no row.
constexpr std::byte kRubbish{0xFF};
constexpr VkOffset2D kMargin{24, 12};

template <class T> void append(std::vector<std::byte>& bytes, const T& value) {
    const auto* from = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), from, from + sizeof(value));
}

std::vector<std::byte> packVectors(VkFormat format, const std::vector<glm::vec2>& vectors) {
    std::vector<std::byte> bytes;
    for (const glm::vec2& vector : vectors)
        if (format == VK_FORMAT_R16G16_SFLOAT)
            append(bytes, glm::packHalf2x16(vector));
        else
            append(bytes, vector);
    return bytes;
}

std::vector<std::byte> packDepth(VkFormat format, const std::vector<float>& depth) {
    std::vector<std::byte> bytes;
    for (const float value : depth)
        if (format == VK_FORMAT_D16_UNORM)
            append(bytes, uint16_t(std::clamp(value, 0.0f, 1.0f) * 65535.0f + 0.5f));
        else if (format == VK_FORMAT_R16_SFLOAT)
            append(bytes, glm::packHalf1x16(value));
        else
            append(bytes, value);
    return bytes;
}

bool isDepthFormat(VkFormat format) {
    return (gpu::aspectOf(format) & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
}

} // namespace

void CheckedImages::describe(GivenFrame& given) {
    motion_blur::HostInputs& inputs = given.inputs;
    std::vector<uint64_t> halves;
    for (const glm::vec4& color : given.color)
        halves.push_back(packHalf(color));
    inputs.color = make(VK_FORMAT_R16G16B16A16_SFLOAT, bytesOf(halves), sizeof(uint64_t), 1);
    if (given.hasIds)
        inputs.entityId = make(VK_FORMAT_R32_UINT, bytesOf(given.ids), sizeof(uint32_t), 1);
    if (given.isNative) {
        std::vector<glm::vec4> texels;
        for (size_t i = 0; i < kCheckedPixels; ++i)
            texels.emplace_back(given.motion[i], given.metres[i], 0.0f);
        inputs.motionDepth =
            make(VK_FORMAT_R32G32B32A32_SFLOAT, bytesOf(texels), sizeof(glm::vec4), 1);
        return;
    }
    if (given.hasVectors) {
        const auto vectors = packVectors(given.vectorFormat, given.motion);
        inputs.convention.vectors.image =
            make(given.vectorFormat, vectors, vectors.size() / kCheckedPixels, given.coarseness);
    }
    const auto depth = packDepth(given.depthFormat, given.depth);
    inputs.convention.depth.image =
        make(given.depthFormat, depth, depth.size() / kCheckedPixels, given.coarseness);
}

motion_blur::HostImage CheckedImages::make(
    VkFormat format, std::span<const std::byte> texels, size_t texelBytes, uint32_t coarseness
) {
    const VkExtent2D extent{kCheckedWidth / coarseness, kCheckedHeight / coarseness};
    const VkOffset2D margin = mPlacing.isSurrounded ? kMargin : VkOffset2D{0, 0};
    const VkExtent2D whole{
        extent.width + 2 * uint32_t(margin.x), extent.height + 2 * uint32_t(margin.y)};
    std::vector<std::byte> placed(size_t{whole.width} * whole.height * texelBytes, kRubbish);
    for (uint32_t y = 0; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x) {
            const size_t from = (size_t{y} * kCheckedWidth + x) * coarseness;
            const size_t to = size_t{y + uint32_t(margin.y)} * whole.width + x + uint32_t(margin.x);
            std::memcpy(
                placed.data() + to * texelBytes, texels.data() + from * texelBytes, texelBytes
            );
        }
    const VkRect2D part = mPlacing.part;
    const auto scaled = [&](auto value) { return value / decltype(value)(coarseness); };
    const VkRect2D area{
        {margin.x + scaled(part.offset.x), margin.y + scaled(part.offset.y)},
        {scaled(part.extent.width), scaled(part.extent.height)}};
    if (mPlacing.layer) {
        motion_blur::HostImage image = makeLayer(format, whole, placed);
        image.area = area;
        return image;
    }
    const VkImageUsageFlags more = isDepthFormat(format) ? 0 : VK_IMAGE_USAGE_STORAGE_BIT;
    return mTexels.emplace_back(mDevice, format, whole, placed, more).describe(area);
}

motion_blur::HostImage
CheckedImages::makeLayer(VkFormat format, VkExtent2D extent, std::span<const std::byte> texels) {
    const std::vector<std::byte> rubbish(texels.size(), kRubbish);
    const auto stage = [&](std::span<const std::byte> bytes) {
        gpu::Buffer buffer(mDevice, "layer", bytes.size(), 0, gpu::MemoryUse::Staging);
        buffer.writeBytes(bytes.data(), bytes.size(), 0);
        return buffer;
    };
    const Layered& made = mLayered.emplace_back(Layered{
        std::make_unique<TwoLayers>(mDevice, format, extent),
        stage(texels),
        stage(rubbish),
        *mPlacing.layer});
    motion_blur::HostImage image{made.image->image, kWritten, kCopied};
    image.format = format;
    image.extent = extent;
    image.layer = made.layer;
    image.usage = made.image->usage;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    return image;
}

void CheckedImages::record(VkCommandBuffer commands) const {
    for (const HostTexels& one : mTexels)
        one.record(commands);
    for (const Layered& one : mLayered) {
        one.image->copyFrom(commands, one.texels, one.layer);
        one.image->copyFrom(commands, one.rubbish, 1 - one.layer);
    }
}

} // namespace shutter::test
