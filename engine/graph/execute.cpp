// SPDX-License-Identifier: MIT
#include "engine/graph/execute.h"

#include "engine/core/check.h"

#include <algorithm>
#include <utility>

namespace shutter::graph {

const gpu::Image& PassResources::image(ImageHandle handle) const {
    SHUTTER_CHECK(
        handle.resource < mGraph.resources().size(),
        "image handle {} is of no graph",
        handle.resource
    );
    const ResourceRecord& record = mGraph.resources()[handle.resource];
    const gpu::Image* image = record.imported ? record.importedImage : mPool.image(handle.resource);
    SHUTTER_CHECK(image != nullptr, "image '{}' is used by no pass of this frame", record.name);
    return *image;
}

VkBuffer PassResources::buffer(BufferHandle handle) const {
    SHUTTER_CHECK(
        handle.resource < mGraph.resources().size(),
        "buffer handle {} is of no graph",
        handle.resource
    );
    const ResourceRecord& record = mGraph.resources()[handle.resource];
    if (record.imported)
        return record.importedBuffer;
    const gpu::Buffer* buffer = mPool.buffer(handle.resource);
    SHUTTER_CHECK(buffer != nullptr, "buffer '{}' is used by no pass of this frame", record.name);
    return buffer->handle();
}

VkDeviceAddress PassResources::address(BufferHandle handle) const {
    const gpu::Buffer* buffer = mPool.buffer(handle.resource);
    SHUTTER_CHECK(
        buffer != nullptr, "buffer handle {} is no transient of this frame", handle.resource
    );
    return buffer->address();
}

namespace {

VkImageMemoryBarrier2 fill(const ImageBarrier& barrier, const gpu::Image& image) {
    VkImageMemoryBarrier2 out{};
    out.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    out.srcStageMask = barrier.srcStages;
    out.srcAccessMask = barrier.srcAccess;
    out.dstStageMask = barrier.dstStages;
    out.dstAccessMask = barrier.dstAccess;
    out.oldLayout = barrier.oldLayout;
    out.newLayout = barrier.newLayout;
    out.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    out.image = image.handle();
    out.subresourceRange = {
        gpu::aspectOf(image.desc().format), 0, VK_REMAINING_MIP_LEVELS, image.desc().layer, 1};
    return out;
}

VkBufferMemoryBarrier2 fill(const BufferBarrier& barrier, VkBuffer buffer) {
    VkBufferMemoryBarrier2 out{};
    out.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2;
    out.srcStageMask = barrier.srcStages;
    out.srcAccessMask = barrier.srcAccess;
    out.dstStageMask = barrier.dstStages;
    out.dstAccessMask = barrier.dstAccess;
    out.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    out.buffer = buffer;
    out.size = VK_WHOLE_SIZE;
    return out;
}

void recordBarriers(
    VkCommandBuffer commands,
    const PassResources& resources,
    const std::vector<ImageBarrier>& images,
    const std::vector<BufferBarrier>& buffers
) {
    if (images.empty() && buffers.empty())
        return;
    // The handles carry no graph here: barriers come from the plan of this very graph.
    std::vector<VkImageMemoryBarrier2> imageBarriers;
    for (const ImageBarrier& barrier : images)
        imageBarriers.push_back(fill(barrier, resources.image({barrier.resource})));
    std::vector<VkBufferMemoryBarrier2> bufferBarriers;
    for (const BufferBarrier& barrier : buffers)
        bufferBarriers.push_back(fill(barrier, resources.buffer({barrier.resource})));
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = static_cast<uint32_t>(imageBarriers.size());
    dependency.pImageMemoryBarriers = imageBarriers.data();
    dependency.bufferMemoryBarrierCount = static_cast<uint32_t>(bufferBarriers.size());
    dependency.pBufferMemoryBarriers = bufferBarriers.data();
    vkCmdPipelineBarrier2(commands, &dependency);
}

/// Clear, load, or nothing worth loading.
VkAttachmentLoadOp findLoadOp(const PassRecord& pass, uint32_t resource, bool clears) {
    if (clears)
        return VK_ATTACHMENT_LOAD_OP_CLEAR;
    const auto use =
        std::find_if(pass.uses.begin(), pass.uses.end(), [&](const ResourceUse& other) {
            return other.resource == resource;
        });
    return use->readVersion == kNoVersion ? VK_ATTACHMENT_LOAD_OP_DONT_CARE
                                          : VK_ATTACHMENT_LOAD_OP_LOAD;
}

VkRenderingAttachmentInfo fillAttachment(
    const gpu::Image& image, VkImageLayout layout, VkAttachmentLoadOp loadOp, bool isWanted
) {
    VkRenderingAttachmentInfo out{};
    out.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    out.imageView = image.view();
    out.imageLayout = layout;
    out.loadOp = loadOp;
    out.storeOp = isWanted ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
    return out;
}

void setViewport(VkCommandBuffer commands, VkExtent2D size) {
    VkViewport viewport{};
    viewport.width = static_cast<float>(size.width);
    viewport.height = static_cast<float>(size.height);
    viewport.maxDepth = 1.0f;
    const VkRect2D scissor{{0, 0}, size};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
}

/// \param position of the pass in the plan
void beginRendering(
    VkCommandBuffer commands,
    const PassRecord& pass,
    const PassResources& resources,
    const Graph& graph,
    const Plan& plan,
    uint32_t position
) {
    VkExtent2D size{};
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const ColorTarget& target : pass.colorTargets) {
        const gpu::Image& image = resources.image({target.resource});
        size = {image.desc().width, image.desc().height};
        VkRenderingAttachmentInfo& color = colors.emplace_back(fillAttachment(
            image,
            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
            findLoadOp(pass, target.resource, target.clear.has_value()),
            isWantedAfter(graph, plan, target.resource, position)
        ));
        for (int i = 0; target.clear && i < 4; ++i)
            color.clearValue.color.uint32[i] = target.clear->u[i];
    }
    VkRenderingAttachmentInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    if (pass.depthTarget) {
        const DepthTarget& target = *pass.depthTarget;
        const gpu::Image& image = resources.image({target.resource});
        size = {image.desc().width, image.desc().height};
        depth = fillAttachment(
            image,
            VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
            findLoadOp(pass, target.resource, target.clear.has_value()),
            isWantedAfter(graph, plan, target.resource, position)
        );
        depth.clearValue.depthStencil = {target.clear.value_or(0.0f), 0};
    }
    VkRenderingInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    rendering.renderArea.extent = size;
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = static_cast<uint32_t>(colors.size());
    rendering.pColorAttachments = colors.data();
    rendering.pDepthAttachment = pass.depthTarget ? &depth : nullptr;
    vkCmdBeginRendering(commands, &rendering);
    setViewport(commands, size);
}

} // namespace

namespace {

/// lavapipe gains nothing by passes that overlap, and its timestamps do not wait for them.
DisjointWrites chooseDisjointWrites(const gpu::Device& device) {
    const bool isSoftware = device.info().kind == "software";
    return isSoftware || device.isValidated() ? DisjointWrites::Ordered : DisjointWrites::Overlap;
}

} // namespace

core::Result<Plan> execute(const Graph& graph, gpu::Frame& frame, TransientPool& pool) {
    core::Result<Plan> compiled =
        compile(graph, pool.requirementFunction(), chooseDisjointWrites(frame.device()));
    if (!compiled)
        return compiled;
    const Plan& plan = compiled.value();
    pool.realize(graph, plan);

    const PassResources resources(graph, pool);
    PassContext context{frame, resources, VK_NULL_HANDLE};
    for (uint32_t position = 0; position < plan.passes.size(); ++position) {
        const PlannedPass& planned = plan.passes[position];
        const PassRecord& pass = graph.passes()[planned.pass];
        if (pass.startsBatch)
            frame.startBatch();
        const VkCommandBuffer commands = context.commands = frame.commands();
        frame.beginSpan(pass.name);
        recordBarriers(commands, resources, planned.imageBarriers, planned.bufferBarriers);
        if (pass.kind == PassKind::Raster)
            beginRendering(commands, pass, resources, graph, plan, position);
        pass.execute(context);
        if (pass.kind == PassKind::Raster)
            vkCmdEndRendering(commands);
        frame.endSpan();
    }
    recordBarriers(frame.commands(), resources, plan.finalImageBarriers, plan.finalBufferBarriers);
    return compiled;
}

} // namespace shutter::graph
