// SPDX-License-Identifier: MIT
#include "engine/graph/transient_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace shutter::graph {

namespace {

/// Several plans' images wait for them: a frame with every method's intermediates has about thirty.
constexpr uint64_t kMaxIdleImages = 128;

/// Frames for which unused objects are cached: a second or two, so that motion may pause.
constexpr uint64_t kRoundsKept = 100;

gpu::ImageDesc describe(const TransientImageDesc& desc, VkImageUsageFlags usage) {
    gpu::ImageDesc result;
    result.width = desc.width;
    result.height = desc.height;
    result.format = desc.format;
    result.usage = usage;
    result.samples = desc.samples;
    return result;
}

} // namespace

void TransientPool::keepFor(uint32_t width, uint32_t height) {
    if (width == mSize.width && height == mSize.height)
        return;
    const bool holdsAny = heldBytes() > 0;
    clear();
    if (holdsAny)
        freeRetired();
    mSize = {width, height};
}

void TransientPool::realize(const Graph& graph, const Plan& plan) {
    mImageSlots.clear();
    mBufferSlots.clear();
    realizeImages(graph, plan);
    realizeBuffers(graph, plan);
}

void TransientPool::realizeImages(const Graph& graph, const Plan& plan) {
    if (mBlock && plan.blockBytes > mBlockBytes) {
        clearImages(); // first: there may be no room for both blocks
        freeRetired();
    }
    mImages.beginRound();
    const auto makeKey = [&](const Placement& placement) {
        const ResourceRecord& resource = graph.resources()[placement.resource];
        return ImageKey{resource.imageDesc, placement.imageUsage, placement.offset};
    };
    std::vector<const Placement*> missing;
    for (const Placement& placement : plan.images) {
        const gpu::Image* kept = mImages.use(makeKey(placement));
        mImageSlots[placement.resource] = kept;
        if (!kept)
            missing.push_back(&placement);
    }
    uint32_t typeBits = UINT32_MAX;
    std::vector<gpu::Image> images;
    for (const Placement* placement : missing) {
        const ResourceRecord& resource = graph.resources()[placement->resource];
        images.push_back(gpu::Image::createUnbound(
            mDevice, resource.name, describe(resource.imageDesc, placement->imageUsage)
        ));
        typeBits &= images.back().requirements().memoryTypeBits;
        if (typeBits == 0)
            throw gpu::DeviceError(fmt::format(
                "no memory type of {} can hold both '{}' and the frame's other images",
                mDevice.info().name,
                resource.name
            ));
    }
    if (!mBlock && !images.empty()) {
        mBlock = gpu::MemoryBlock(mDevice, plan.blockBytes, typeBits);
        mBlockBytes = plan.blockBytes;
    }
    if (!images.empty() && (typeBits & (1u << mBlock.type())) == 0) {
        // A kind of image that this block cannot hold: one for all of them, from the start.
        clearImages();
        freeRetired();
        realizeImages(graph, plan);
        return;
    }
    for (size_t i = 0; i < images.size(); ++i) {
        images[i].bind(mBlock.handle(), missing[i]->offset);
        mImageSlots[missing[i]->resource] = mImages.add(makeKey(*missing[i]), std::move(images[i]));
    }
    mImages.dropUnused(kRoundsKept);
    mImages.dropIdle(kMaxIdleImages, [](const ImageKey&) { return 1; });
}

void TransientPool::realizeBuffers(const Graph& graph, const Plan& plan) {
    const auto bytesOf = [](const BufferKey& key) { return key.bytes; };
    mBuffers.beginRound();
    VkDeviceSize usedBytes = 0;
    for (const Placement& placement : plan.buffers) {
        const BufferKey key{placement.bytes, placement.bufferUsage};
        const gpu::Buffer* buffer = mBuffers.use(key);
        if (!buffer)
            buffer = mBuffers.add(
                key,
                gpu::Buffer(
                    mDevice,
                    graph.resources()[placement.resource].name,
                    key.bytes,
                    key.usage,
                    gpu::MemoryUse::Device
                )
            );
        mBufferSlots[placement.resource] = buffer;
        usedBytes += key.bytes;
    }
    mMostBufferBytes = std::max(mMostBufferBytes, usedBytes);
    mBuffers.dropUnused(kRoundsKept);
    mBuffers.dropIdle(mMostBufferBytes, bytesOf);
}

const gpu::Image* TransientPool::image(uint32_t resource) const {
    const auto slot = mImageSlots.find(resource);
    return slot == mImageSlots.end() ? nullptr : slot->second;
}

const gpu::Buffer* TransientPool::buffer(uint32_t resource) const {
    const auto slot = mBufferSlots.find(resource);
    return slot == mBufferSlots.end() ? nullptr : slot->second;
}

VkDeviceSize TransientPool::heldBytes() const {
    return mBlockBytes + mBuffers.sum([](const BufferKey& key) { return key.bytes; });
}

void TransientPool::clearImages() {
    mImageSlots.clear();
    mImages.clear();
    mBlock = {};
    mBlockBytes = 0;
}

void TransientPool::freeRetired() {
    // Destroyed objects live on until the next submission is done: memory would be taken twice.
    if (!mDevice.isAdopted())
        mDevice.collectIdle();
}

void TransientPool::clear() {
    clearImages();
    mBufferSlots.clear();
    mBuffers.clear();
    mMostBufferBytes = 0;
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
