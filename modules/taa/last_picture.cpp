// SPDX-License-Identifier: MIT
#include "modules/taa/last_picture.h"

#include "engine/gpu/vulkan.h"

#include <span>
#include <utility>

namespace shutter::taa {

namespace {

gpu::ImageDesc describeImage(const render::ViewFacts& facts, VkFormat format) {
    gpu::ImageDesc desc;
    desc.width = facts.width;
    desc.height = facts.height;
    desc.format = format;
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT; // for those who want to see it
    return desc;
}

} // namespace

void LastPicture::extract(const render::ExtractContext& context) {
    mReprojection = extract::computeReprojection(
        context.world, context.view, context.motion, context.frame, mRecord ? &*mRecord : nullptr
    );
}

LastPicture::Frame LastPicture::turn(const render::PostContext& context) {
    mRecord = std::move(mReprojection.record);
    Frame frame;
    frame.isPerspective = mReprojection.isPerspective;
    if (mReprojection.last) {
        frame.last = &mImages.at(mNewest);
        frame.places = writePlaces(*mReprojection.last, mBuffers.at(context.slot));
        if (context.facts.exposureSeconds > 0.0)
            frame.motionScale = float(mReprojection.ageSeconds / context.facts.exposureSeconds);
    }
    mNewest = 1 - mNewest;
    Images& kept = mImages.at(mNewest);
    const auto make = [&](gpu::Image& image, const char* name, VkFormat format) {
        const gpu::ImageDesc desc = describeImage(context.facts, format);
        if (!image.handle() || !(image.desc() == desc))
            image = gpu::Image(mDevice, name, desc);
    };
    make(kept.picture, "anti-aliased picture", VK_FORMAT_R16G16B16A16_SFLOAT);
    make(kept.depth, "depth of the anti-aliased picture", VK_FORMAT_R32_SFLOAT);
    frame.kept = &kept;
    return frame;
}

shader::LayerMotion
LastPicture::writePlaces(const math::LayerTables& tables, gpu::Buffer& buffer) const {
    constexpr VkDeviceSize kAlignment = 16;
    const VkDeviceSize moverBytes = tables.movers.size() * sizeof(uint32_t);
    const VkDeviceSize motionsAt = (moverBytes + kAlignment - 1) / kAlignment * kAlignment;
    const VkDeviceSize bytes = motionsAt + tables.motions.size() * sizeof(shader::InstantMotion);
    if (buffer.bytes() < bytes)
        buffer = gpu::Buffer(
            mDevice,
            "last places",
            bytes + bytes / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
    buffer.write(std::span<const uint32_t>(tables.movers), 0);
    buffer.write(std::span<const shader::InstantMotion>(tables.motions), motionsAt);
    return {
        gpu::splitAddress(buffer.address()),
        gpu::splitAddress(buffer.address() + motionsAt),
        static_cast<uint32_t>(tables.movers.size() - 1),
        tables.isStill ? 1u : 0u};
}

void LastPicture::forget() {
    mRecord.reset();
    mImages = {};
    mBuffers = {};
}

} // namespace shutter::taa
