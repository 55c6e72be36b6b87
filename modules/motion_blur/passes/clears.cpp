// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/clears.h"

#include "engine/core/check.h"
#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

using graph::Access;

void Clears::add(graph::ImageHandle image) {
    mAdded.images.push_back(image);
}

void Clears::add(graph::BufferHandle buffer, uint32_t word) {
    mAdded.buffers.push_back({buffer, Kind::Whole, word});
}

void Clears::addHead(graph::BufferHandle list, uint32_t bytes) {
    mAdded.buffers.push_back({list, Kind::Head, bytes});
}

void Clears::addArguments(graph::BufferHandle arguments, uint32_t listCount) {
    mAdded.buffers.push_back({arguments, Kind::Arguments, listCount});
}

void Clears::declare(graph::Graph& graph) {
    mCleared = graph.addPass<Resources>(
        "clear lists",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Resources& data) {
            data = mAdded;
            for (graph::ImageHandle& image : data.images)
                image = builder.write(image, Access::TransferWrite);
            for (Buffer& buffer : data.buffers)
                buffer.handle = builder.write(buffer.handle, Access::TransferWrite);
        },
        [](const Resources& data, graph::PassContext& context) { record(data, context); }
    );
}

void Clears::record(const Resources& resources, graph::PassContext& context) {
    const VkClearColorValue zero{};
    const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    for (const graph::ImageHandle image : resources.images)
        vkCmdClearColorImage(
            context.commands,
            context.resources.image(image).handle(),
            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            &zero,
            1,
            &whole
        );
    for (const Buffer& buffer : resources.buffers) {
        const VkBuffer handle = context.resources.buffer(buffer.handle);
        switch (buffer.kind) {
        case Kind::Whole:
            vkCmdFillBuffer(context.commands, handle, 0, VK_WHOLE_SIZE, buffer.number);
            break;
        case Kind::Head:
            vkCmdFillBuffer(context.commands, handle, 0, buffer.number, 0);
            break;
        case Kind::Arguments:
            clearArguments(context, buffer.handle, buffer.number);
            break;
        }
    }
}

graph::ImageHandle Clears::get(graph::ImageHandle image) const {
    for (const graph::ImageHandle& cleared : mCleared.images)
        if (cleared.resource == image.resource)
            return cleared;
    SHUTTER_CHECK(false, "image {} is not cleared", image.resource);
    return {};
}

graph::BufferHandle Clears::get(graph::BufferHandle buffer) const {
    for (const Buffer& cleared : mCleared.buffers)
        if (cleared.handle.resource == buffer.resource)
            return cleared.handle;
    SHUTTER_CHECK(false, "buffer {} is not cleared", buffer.resource);
    return {};
}

} // namespace shutter::motion_blur
