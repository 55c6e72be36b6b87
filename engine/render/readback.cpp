// SPDX-License-Identifier: MIT
#include "engine/render/readback.h"

#include "engine/core/check.h"
#include "engine/gpu/frame.h"
#include "engine/graph/execute.h"

#include <glm/gtc/packing.hpp>

#include <cstring>
#include <utility>

namespace shutter::render {

namespace {

struct FormatInfo {
    uint32_t channels = 0;
    enum class Type { Half, Float, Unorm8, Unorm10, Uint32 } type = Type::Float;
    bool swapsRedAndBlue = false; ///< stored in the order B, G, R, A
};

FormatInfo describeFormat(VkFormat format) {
    using Type = FormatInfo::Type;
    switch (format) {
    case VK_FORMAT_R16G16_SFLOAT:
        return {2, Type::Half};
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return {4, Type::Half};
    case VK_FORMAT_R32_SFLOAT:
        return {1, Type::Float};
    case VK_FORMAT_R32G32_SFLOAT:
        return {2, Type::Float};
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return {4, Type::Float};
    case VK_FORMAT_R8_UNORM:
        return {1, Type::Unorm8};
    case VK_FORMAT_R8G8B8A8_UNORM:
        return {4, Type::Unorm8};
    case VK_FORMAT_B8G8R8A8_UNORM:
        return {4, Type::Unorm8, true};
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
        return {4, Type::Unorm10};
    case VK_FORMAT_A2R10G10B10_UNORM_PACK32:
        return {4, Type::Unorm10, true};
    case VK_FORMAT_R32_UINT:
        return {1, Type::Uint32};
    default:
        break;
    }
    SHUTTER_CHECK(false, "format {} cannot be read back", static_cast<int>(format));
    return {};
}

template <class T> T load(const void* data, size_t index) {
    T value;
    std::memcpy(&value, static_cast<const char*>(data) + index * sizeof(T), sizeof(T));
    return value;
}

float convert(const void* data, size_t index, FormatInfo::Type type) {
    switch (type) {
    case FormatInfo::Type::Half:
        return glm::unpackHalf1x16(load<uint16_t>(data, index));
    case FormatInfo::Type::Float:
        return load<float>(data, index);
    case FormatInfo::Type::Unorm8:
        return float(load<uint8_t>(data, index)) / 255.0f;
    case FormatInfo::Type::Unorm10: { // four channels a word, alpha of two bits
        const uint32_t word = load<uint32_t>(data, index / 4);
        const uint32_t channel = index % 4;
        return channel == 3 ? float(word >> 30) / 3.0f
                            : float(word >> (10 * channel) & 1023u) / 1023.0f;
    }
    case FormatInfo::Type::Uint32: {
        const auto value = load<uint32_t>(data, index);
        return value == UINT32_MAX ? -1.0f : static_cast<float>(value);
    }
    }
    return 0.0f;
}

} // namespace

size_t Readback::add(graph::Graph& graph, const std::string& name, graph::ImageHandle image) {
    const graph::TransientImageDesc desc = graph.describeImage(image);
    const VkDeviceSize bytes =
        VkDeviceSize(desc.width) * desc.height * gpu::texelBytes(desc.format);
    const size_t ticket = mEntries.size();
    if (mBuffers.size() <= ticket || mBuffers[ticket].bytes() < bytes) {
        gpu::Buffer buffer(mDevice, "readback", bytes, 0, gpu::MemoryUse::Readback);
        if (mBuffers.size() <= ticket)
            mBuffers.push_back(std::move(buffer));
        else
            mBuffers[ticket] = std::move(buffer);
    }
    mEntries.push_back({ticket, desc});

    struct Data {
        graph::ImageHandle source;
        graph::BufferHandle target;
    };

    const auto imported = graph.importBuffer("readback " + name, mBuffers[ticket].handle(), bytes);
    graph.addPass<Data>(
        "readback " + name,
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Data& data) {
            data.source = builder.read(image, graph::Access::TransferRead);
            data.target = builder.write(imported, graph::Access::TransferWrite);
            graph.markOutput(data.target);
        },
        [](const Data& data, graph::PassContext& context) {
            const gpu::Image& source = context.resources.image(data.source);
            VkBufferImageCopy region{};
            region.imageSubresource = {gpu::aspectOf(source.desc().format), 0, 0, 1};
            region.imageExtent = {source.desc().width, source.desc().height, 1};
            vkCmdCopyImageToBuffer(
                context.commands,
                source.handle(),
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                context.resources.buffer(data.target),
                1,
                &region
            );
        }
    );
    return ticket;
}

std::span<const std::byte> Readback::bytes(size_t ticket) const {
    SHUTTER_CHECK(ticket < mEntries.size(), "ticket {} of {}", ticket, mEntries.size());
    const Entry& entry = mEntries[ticket];
    const size_t count =
        size_t(entry.desc.width) * entry.desc.height * gpu::texelBytes(entry.desc.format);
    return {static_cast<const std::byte*>(mBuffers[entry.buffer].mapped()), count};
}

image::Image Readback::take(size_t ticket) const {
    SHUTTER_CHECK(ticket < mEntries.size(), "ticket {} of {}", ticket, mEntries.size());
    const Entry& entry = mEntries[ticket];
    const FormatInfo info = describeFormat(entry.desc.format);
    image::Image picture(entry.desc.width, entry.desc.height, info.channels);
    const void* data = mBuffers[entry.buffer].mapped();
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = convert(data, i, info.type);
    for (size_t i = 0; info.swapsRedAndBlue && i < picture.pixels.size(); i += info.channels)
        std::swap(picture.pixels[i], picture.pixels[i + 2]);
    return picture;
}

} // namespace shutter::render
