// SPDX-License-Identifier: MIT
#include "engine/graph/transient_pool.h"

#include <fmt/format.h>

#include <algorithm>

namespace shutter::graph {

namespace {

gpu::ImageDesc describe(const TransientImageDesc& desc, VkImageUsageFlags usage) {
    gpu::ImageDesc result;
    result.width = desc.width;
    result.height = desc.height;
    result.format = desc.format;
    result.usage = usage;
    return result;
}

} // namespace

void TransientPool::realize(const Graph& graph, const Plan& plan) {
    std::vector<ImageKey> imageKeys;
    mImageSlots.clear();
    for (const Placement& image : plan.images) {
        mImageSlots[image.resource] = imageKeys.size();
        imageKeys.push_back(
            {graph.resources()[image.resource].imageDesc, image.imageUsage, image.offset}
        );
    }
    std::vector<BufferKey> bufferKeys;
    mBufferSlots.clear();
    for (const Placement& buffer : plan.buffers) {
        mBufferSlots[buffer.resource] = bufferKeys.size();
        bufferKeys.push_back({buffer.bytes, buffer.bufferUsage});
    }
    // Equal keys were packed into a block of equal size, so the keys alone decide.
    if (imageKeys != mImageKeys) {
        makeImages(graph, plan);
        mImageKeys = std::move(imageKeys);
    }
    if (bufferKeys != mBufferKeys) {
        makeBuffers(graph, plan);
        mBufferKeys = std::move(bufferKeys);
    }
}

void TransientPool::makeImages(const Graph& graph, const Plan& plan) {
    // The old ones go first, and their keys with them: should a step below throw, the next frame
    // starts from nothing.
    mImageKeys.clear();
    mImages.clear();
    mBlock = {};
    mBlockBytes = 0;
    if (plan.images.empty())
        return;
    uint32_t typeBits = UINT32_MAX;
    std::vector<gpu::Image> images;
    for (const Placement& placement : plan.images) {
        const ResourceRecord& resource = graph.resources()[placement.resource];
        images.push_back(gpu::Image::createUnbound(
            mDevice, resource.name, describe(resource.imageDesc, placement.imageUsage)
        ));
        typeBits &= images.back().requirements().memoryTypeBits;
        if (typeBits == 0)
            throw gpu::DeviceError(fmt::format(
                "no memory type of {} can hold both '{}' and the frame's other images",
                mDevice.info().name,
                resource.name
            ));
    }
    gpu::MemoryBlock block(mDevice, plan.blockBytes, typeBits);
    for (size_t i = 0; i < images.size(); ++i)
        images[i].bind(block.handle(), plan.images[i].offset);
    mBlock = std::move(block);
    mBlockBytes = plan.blockBytes;
    mImages = std::move(images);
}

void TransientPool::makeBuffers(const Graph& graph, const Plan& plan) {
    mBufferKeys.clear();
    mBuffers.clear();
    for (const Placement& placement : plan.buffers)
        mBuffers.emplace_back(
            mDevice,
            graph.resources()[placement.resource].name,
            placement.bytes,
            placement.bufferUsage,
            gpu::MemoryUse::Device
        );
}

const gpu::Image* TransientPool::image(uint32_t resource) const {
    const auto slot = mImageSlots.find(resource);
    return slot == mImageSlots.end() ? nullptr : &mImages[slot->second];
}

const gpu::Buffer* TransientPool::buffer(uint32_t resource) const {
    const auto slot = mBufferSlots.find(resource);
    return slot == mBufferSlots.end() ? nullptr : &mBuffers[slot->second];
}

VkDeviceSize TransientPool::heldBytes() const {
    VkDeviceSize bytes = mBlockBytes;
    for (const gpu::Buffer& buffer : mBuffers)
        bytes += buffer.bytes();
    return bytes;
}

void TransientPool::clear() {
    mImageSlots.clear();
    mBufferSlots.clear();
    mImageKeys.clear();
    mBufferKeys.clear();
    mImages.clear();
    mBuffers.clear();
    mBlock = {};
    mBlockBytes = 0;
}

MemoryRequirement
TransientPool::askRequirement(const TransientImageDesc& desc, VkImageUsageFlags usage) {
    const auto known = std::find_if(
        mRequirements.begin(),
        mRequirements.end(),
        [&](const KnownRequirement& entry) { return entry.desc == desc && entry.usage == usage; }
    );
    if (known != mRequirements.end())
        return known->requirement;
    const gpu::Image probe =
        gpu::Image::createUnbound(mDevice, "size probe", describe(desc, usage));
    const VkMemoryRequirements needed = probe.requirements();
    mRequirements.push_back({desc, usage, {needed.size, needed.alignment}});
    return mRequirements.back().requirement;
}

RequirementFunction TransientPool::requirementFunction() {
    return [this](const TransientImageDesc& desc, VkImageUsageFlags usage) {
        return askRequirement(desc, usage);
    };
}

} // namespace shutter::graph
