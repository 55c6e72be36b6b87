// SPDX-License-Identifier: MIT
#include "game/replay/dump_on_device.h"

#include "spirv/motion_blur/replay_reveal.comp.h"

namespace shutter::replay {

namespace {

constexpr graph::OutsideUse kUploaded{
    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
    VK_ACCESS_2_TRANSFER_WRITE_BIT};

VkFormat formatOf(Texels texels) {
    switch (texels) {
    case Texels::Half4:
        return VK_FORMAT_R16G16B16A16_SFLOAT;
    case Texels::Float1:
        return VK_FORMAT_R32_SFLOAT;
    case Texels::Float2:
        return VK_FORMAT_R32G32_SFLOAT;
    case Texels::Float4:
        return VK_FORMAT_R32G32B32A32_SFLOAT;
    case Texels::Uint1:
        break;
    }
    return VK_FORMAT_R32_UINT;
}

struct Push {
    glm::uvec2 sizePx;
    glm::uvec2 color;
    glm::uvec2 motionDepth;
    glm::uvec2 entityId;
};

} // namespace

UploadedImage::UploadedImage(gpu::Device& device, const DumpImage& from)
    : mArea(from.area), mImage(
                            device,
                            from.file,
                            {from.width,
                             from.height,
                             formatOf(from.texels),
                             VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                 VK_IMAGE_USAGE_TRANSFER_DST_BIT}
                        ),
      mStaging(device, from.file, from.bytes.size(), 0, gpu::MemoryUse::Staging) {
    mStaging.writeBytes(from.bytes.data(), from.bytes.size(), 0);
}

void UploadedImage::record(VkCommandBuffer commands) const {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.dstStageMask = kUploaded.stages;
    barrier.dstAccessMask = kUploaded.access;
    barrier.newLayout = kUploaded.layout;
    barrier.image = mImage.handle();
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {mImage.desc().width, mImage.desc().height, 1};
    vkCmdCopyBufferToImage(
        commands, mStaging.handle(), mImage.handle(), kUploaded.layout, 1, &region
    );
}

motion_blur::HostImage UploadedImage::describe() const {
    motion_blur::HostImage image{mImage.handle(), kUploaded, kCopied};
    image.format = mImage.desc().format;
    image.extent = {mImage.desc().width, mImage.desc().height};
    image.area = mArea;
    image.usage = mImage.desc().usage;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    return image;
}

ReplayedReveal::ReplayedReveal(gpu::Device& device)
    : mDevice(device), mFrame(gpu::Frame::createForHost(device)) {
    gpu::ComputePipelineDesc desc;
    desc.name = "replay reveal";
    desc.spirv = motion_blur_replay_reveal_comp;
    desc.interface.bindings.assign(3, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    desc.interface.pushConstantBytes = sizeof(Push);
    mPipeline.emplace(device, desc);
}

motion_blur::HostReveal ReplayedReveal::answer(const DumpFrame& frame) {
    mTargets.clear();
    mTexels.clear();
    for (const char* name : {"revealColor", "revealMotionDepth", "revealEntityId"}) {
        const std::vector<uint8_t>& bytes = frame.find(name)->bytes;
        mTexels.emplace_back(
            mDevice, name, bytes.size(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Staging
        );
        mTexels.back().writeBytes(bytes.data(), bytes.size(), 0);
    }
    motion_blur::HostReveal reveal;
    reveal.record = [this](const motion_blur::RevealTask& task) { record(task); };
    return reveal;
}

void ReplayedReveal::record(const motion_blur::RevealTask& task) {
    const auto adopt = [&](VkImage image, VkFormat format) -> const gpu::Image& {
        return mTargets.emplace_back(gpu::Image::adopt(
            mDevice,
            "revealed",
            image,
            {task.width, task.height, format, VK_IMAGE_USAGE_STORAGE_BIT}
        ));
    };
    gpu::BindingList bindings;
    bindings.storage(adopt(task.color.image, VK_FORMAT_R16G16B16A16_SFLOAT))
        .storage(adopt(task.motionDepth.image, VK_FORMAT_R32G32B32A32_SFLOAT))
        .storage(adopt(task.entityId.image, VK_FORMAT_R32_UINT));
    const Push push{
        {task.width, task.height},
        gpu::splitAddress(mTexels[0].address()),
        gpu::splitAddress(mTexels[1].address()),
        gpu::splitAddress(mTexels[2].address())};
    mFrame->beginIn(task.commands);
    mFrame->bind(*mPipeline, bindings, &push, sizeof(push));
    vkCmdDispatch(task.commands, (task.width + 7) / 8, (task.height + 7) / 8, 1);
}

motion_blur::HostBlended ReplayedDraws::answer(const DumpFrame& frame) {
    mColors.clear();
    mOpacities.clear();
    const DumpedDraws& drawn = *frame.drawn;
    for (uint32_t part = 0; part < drawn.partCount; ++part)
        for (const bool isOpacity : {false, true}) {
            const DumpImage* const image = frame.find(nameDrawnImage(part, isOpacity));
            if (!image)
                continue; // it is in alpha
            gpu::Buffer& texels = (isOpacity ? mOpacities : mColors).emplace_back();
            texels = gpu::Buffer(mDevice, "drawn", image->bytes.size(), 0, gpu::MemoryUse::Staging);
            texels.writeBytes(image->bytes.data(), image->bytes.size(), 0);
        }
    motion_blur::HostBlended own;
    own.record = [this](const motion_blur::BlendedTask& task) { record(task); };
    own.area = drawn.area;
    own.instantCount = drawn.instantCount;
    own.partCount = drawn.partCount;
    own.isOpacityInAlpha = drawn.isOpacityInAlpha;
    return own;
}

void ReplayedDraws::record(const motion_blur::BlendedTask& task) const {
    const auto copy = [&](const gpu::Buffer& texels, VkImage image) {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {task.area.extent.width, task.area.extent.height, 1};
        vkCmdCopyBufferToImage(
            task.commands, texels.handle(), image, VK_IMAGE_LAYOUT_GENERAL, 1, &region
        );
    };
    copy(mColors[task.part], task.color.image);
    if (task.opacity.image)
        copy(mOpacities[task.part], task.opacity.image);
}

} // namespace shutter::replay
