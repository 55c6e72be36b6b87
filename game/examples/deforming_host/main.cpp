// SPDX-License-Identifier: MIT
// Motion blur by `resolved` of meshes that a renderer deforms itself: a flag that its vertex shader
// waves, with the renderer's own motion vectors and depth buffer, from which it writes "before.ppm"
// and "after.ppm". Shutter's part is marked (1) to (4); bare_renderer has less.
#include "spirv/flag.frag.h"
#include "spirv/flag.vert.h"

#include <glm/gtc/packing.hpp>
#include <shutter_motion_blur.hpp>
#include <vulkan/vulkan_raii.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <vector>

constexpr uint32_t kWidth = 640, kHeight = 360, kFrames = 6;
constexpr float kFrameSeconds = 1.0f / 24.0f, kExposureSeconds = kFrameSeconds / 2.0f;
constexpr float kFocal = 2.0f, kNear = 0.1f; // of the lens; metres
constexpr vk::Extent3D kSize(kWidth, kHeight, 1);
constexpr vk::DeviceSize kBytes = kWidth * kHeight * 8; // of a picture in half floats
constexpr auto kHalf = vk::Format::eR16G16B16A16Sfloat, kDepth = vk::Format::eD32Sfloat;
constexpr std::array kFormats{kHalf, vk::Format::eR16G16Sfloat, vk::Format::eR32Uint, kHalf};
constexpr auto kTarget = vk::ImageLayout::eGeneral, kSource = vk::ImageLayout::eTransferSrcOptimal;
constexpr auto kAny = vk::PipelineStageFlagBits2::eAllCommands;
constexpr auto kWrite = vk::AccessFlagBits2::eMemoryWrite, kRead = vk::AccessFlagBits2::eHostRead;

struct Gpu {
    vk::raii::PhysicalDevice physical;
    vk::raii::Device device;

    vk::raii::DeviceMemory
    allocate(vk::MemoryRequirements of, vk::MemoryPropertyFlags flags) const {
        const auto types = physical.getMemoryProperties().memoryTypes;
        uint32_t type = 0; // Vulkan guarantees a memory type of each kind needed here
        while (!(of.memoryTypeBits >> type & 1) || (types[type].propertyFlags & flags) != flags)
            ++type;
        return {device, vk::MemoryAllocateInfo(of.size, type)};
    }
};

struct Image {
    vk::raii::DeviceMemory memory = nullptr;
    vk::raii::Image image = nullptr;
    vk::raii::ImageView view = nullptr;
    vk::ImageSubresourceRange range;

    Image(const Gpu& gpu, vk::Format format, vk::ImageUsageFlags usage) {
        vk::ImageCreateInfo info({}, vk::ImageType::e2D, format, kSize, 1, 1);
        image = vk::raii::Image(gpu.device, info.setUsage(usage));
        memory = gpu.allocate(image.getMemoryRequirements(), {});
        image.bindMemory(*memory, 0);
        const bool isDepth = format == kDepth;
        using enum vk::ImageAspectFlagBits;
        range = vk::ImageSubresourceRange(isDepth ? eDepth : eColor, 0, 1, 0, 1);
        view = {gpu.device, {{}, *image, vk::ImageViewType::e2D, format, {}, range}};
    }
};

/// Targets of the flag: colour, motion vectors, entity ids, deformed motion; depth.
struct Targets {
    std::vector<Image> images;

    explicit Targets(const Gpu& gpu) {
        using enum vk::ImageUsageFlagBits;
        for (const vk::Format format : kFormats)
            images.emplace_back(gpu, format, eColorAttachment | eSampled | eTransferSrc);
        images.emplace_back(gpu, kDepth, eDepthStencilAttachment | eSampled);
    }

    shutter::BlurImage describe(size_t i, vk::ImageLayout next = kTarget) const {
        const vk::Format format = i < kFormats.size() ? kFormats[i] : kDepth;
        return {*images[i].image, VkImageLayout(kTarget), VkImageLayout(next), VkFormat(format)};
    }
};

struct Push {
    std::array<float, 4> seconds; // of the raster, of shutter open and close, of the previous frame
    std::array<float, 4> lens{kFocal * kHeight / kWidth, -kFocal, kNear, 0.0f};
    std::array<float, 4> sizePx{kWidth, kHeight};
};

vk::raii::Pipeline makePipeline(const Gpu& gpu, vk::PipelineLayout layout) {
    const auto compile = [&](const auto& words) {
        return vk::raii::ShaderModule(gpu.device, {{}, sizeof(words), words});
    };
    const auto vertex = compile(flag_vert), fragment = compile(flag_frag);
    using enum vk::ShaderStageFlagBits;
    const std::array stages{
        vk::PipelineShaderStageCreateInfo({}, eVertex, *vertex, "main"),
        vk::PipelineShaderStageCreateInfo({}, eFragment, *fragment, "main")};
    const vk::PipelineVertexInputStateCreateInfo input;
    const vk::PipelineInputAssemblyStateCreateInfo assembly(
        {}, vk::PrimitiveTopology::eTriangleList
    );
    const vk::Viewport viewport(0, 0, kWidth, kHeight, 0, 1);
    const vk::Rect2D area({}, {kWidth, kHeight});
    const vk::PipelineViewportStateCreateInfo view({}, viewport, area);
    vk::PipelineRasterizationStateCreateInfo raster;
    raster.lineWidth = 1.0f;
    const vk::PipelineMultisampleStateCreateInfo samples;
    const vk::PipelineDepthStencilStateCreateInfo depth({}, true, true, vk::CompareOp::eGreater);
    vk::PipelineColorBlendAttachmentState opaque;
    opaque.colorWriteMask = vk::ColorComponentFlags(0xF);
    const std::array blends{opaque, opaque, opaque, opaque};
    const vk::PipelineColorBlendStateCreateInfo blend({}, false, {}, blends);
    const vk::PipelineRenderingCreateInfo formats(0, kFormats, kDepth);
    vk::GraphicsPipelineCreateInfo info({}, stages, &input, &assembly, nullptr, &view, &raster);
    info.setPMultisampleState(&samples).setPDepthStencilState(&depth).setPColorBlendState(&blend);
    return {gpu.device, nullptr, info.setLayout(layout).setPNext(&formats)};
}

/// Draws the flag as it is at a time, and where it is at three others.
void draw(
    vk::CommandBuffer commands,
    const Targets& targets,
    vk::Pipeline pipeline,
    vk::PipelineLayout layout,
    const Push& push
) {
    std::vector<vk::ImageMemoryBarrier2> barriers;
    std::vector<vk::RenderingAttachmentInfo> attachments;
    for (const Image& image : targets.images) {
        vk::ImageMemoryBarrier2& barrier = barriers.emplace_back();
        barrier.setSrcStageMask(kAny).setSrcAccessMask(kWrite).setDstStageMask(kAny);
        barrier.setDstAccessMask(kWrite).setNewLayout(kTarget).setImage(*image.image);
        barrier.setSubresourceRange(image.range);
        vk::RenderingAttachmentInfo& attachment = attachments.emplace_back();
        attachment.setImageView(*image.view).setImageLayout(kTarget);
        attachment.setLoadOp(vk::AttachmentLoadOp::eClear);
    }
    commands.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, barriers));
    const vk::RenderingAttachmentInfo depth = attachments.back();
    attachments.pop_back();
    commands.beginRendering({{}, {{}, {kWidth, kHeight}}, 1, 0, attachments, &depth});
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline);
    commands.pushConstants<Push>(layout, vk::ShaderStageFlagBits::eAllGraphics, 0, push);
    commands.draw(6 * 48 * 16, 2, 0, 0);
    commands.endRendering();
}

void require(bool isDone, const char* why) {
    if (!isDone)
        throw std::runtime_error(why);
}

void write(const char* path, const uint64_t* halves) {
    std::ofstream file(path, std::ios::binary);
    file << "P6 " << kWidth << ' ' << kHeight << " 255\n";
    for (uint32_t i = 0; i < kWidth * kHeight * 3; ++i)
        file.put(char(255 * glm::min(glm::unpackHalf4x16(halves[i / 3])[i % 3], 1.0f) + 0.5f));
    require(bool(file.flush()), "cannot write the picture");
}

int main() try {
    const vk::raii::Context context;
    const vk::ApplicationInfo application(nullptr, 0, nullptr, 0, VK_API_VERSION_1_3);
    const vk::raii::Instance instance(context, vk::InstanceCreateInfo({}, &application));
    const vk::raii::PhysicalDevice physical = vk::raii::PhysicalDevices(instance).at(0);
    const float priority = 1.0f;
    const vk::DeviceQueueCreateInfo queueInfo({}, 0, 1, &priority);
    auto v13 = vk::PhysicalDeviceVulkan13Features().setDynamicRendering(true);
    auto v12 = vk::PhysicalDeviceVulkan12Features().setPNext(&v13);
    vk::PhysicalDeviceFeatures2 features({}, &v12); // (1) with the effect's features enabled
    require(bool(shutter::MotionBlur::addFeatures(features)), shutterBlurGetMessage());
    const vk::DeviceCreateInfo deviceInfo({}, queueInfo, {}, {}, {}, &features);
    const Gpu gpu{physical, {physical, deviceInfo}};
    const vk::raii::CommandPool pool(
        gpu.device, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, 0}
    );
    const vk::raii::CommandBuffers commands(gpu.device, {*pool, {}, 1});
    const vk::raii::Fence fence(gpu.device, vk::FenceCreateInfo());
    const vk::PushConstantRange range(vk::ShaderStageFlagBits::eAllGraphics, 0, sizeof(Push));
    const vk::raii::PipelineLayout layout(gpu.device, {{}, {}, range});
    const vk::raii::Pipeline pipeline = makePipeline(gpu, *layout);
    const Targets now(gpu), last(gpu);
    using enum vk::ImageUsageFlagBits;
    const Image output(gpu, kHalf, eStorage | eTransferDst | eTransferSrc);
    vk::raii::Buffer copies(gpu.device, {{}, 2 * kBytes, vk::BufferUsageFlagBits::eTransferDst});
    using enum vk::MemoryPropertyFlagBits;
    const auto memory = gpu.allocate(copies.getMemoryRequirements(), eHostVisible | eHostCoherent);
    copies.bindMemory(*memory, 0);
    shutter::BlurDevice device(*physical, *gpu.device, 0, 1);
    const auto complain = [](const char* sentence) { std::fprintf(stderr, "%s\n", sentence); };
    device.setMessage(complain);
    device.checksInputs = VK_TRUE;
    auto blur = shutter::MotionBlur::create(device); // (2) once
    require(bool(blur), blur.message().c_str());

    std::array<ShutterBlurCameraKey, 2> keys{}; // (3) a static camera, a flag without matrices
    for (ShutterBlurCameraKey& key : keys) {
        for (const int i : {0, 5, 10, 15})
            key.viewFromWorld[i] = 1.0;
        key.clipFromView[0] = Push().lens[0];
        key.clipFromView[5] = Push().lens[1];
        key.clipFromView[11] = -1.0;
        key.clipFromView[14] = kNear;
    }
    keys[1].time = 1.0;
    const std::array movers{ShutterBlurMover{1, nullptr}};
    shutter::BlurInputs inputs(kWidth, kHeight);
    inputs.color = now.describe(0, kSource);
    inputs.vectors = now.describe(1); // to the previous frame, in texture coordinates
    inputs.pixelsPerUnit[0] = -float(kWidth);
    inputs.pixelsPerUnit[1] = -float(kHeight);
    inputs.depth = now.describe(4); // reversed: skyValue is 0
    inputs.cameras.areGiven = VK_TRUE;
    shutter::setMatrix(inputs.cameras.viewFromWorld, keys[0].viewFromWorld);
    shutter::setMatrix(inputs.cameras.viewFromWorldBefore, keys[0].viewFromWorld);
    shutter::setMatrix(inputs.cameras.clipFromView, keys[0].clipFromView);
    shutter::setMatrix(inputs.cameras.clipFromViewBefore, keys[0].clipFromView);
    inputs.entityId = now.describe(2);
    inputs.deformedMotion = now.describe(3);
    inputs.output = shutter::BlurImage(*output.image, {}, VkImageLayout(kSource));
    inputs.setKeys(keys);
    inputs.setMovers(movers);
    inputs.rowCount = 2;
    inputs.exposureShare = kExposureSeconds / kFrameSeconds;

    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        const vk::CommandBuffer todo = *commands[0];
        todo.begin(vk::CommandBufferBeginInfo());
        const float close = 1.0f + float(frame) * kFrameSeconds, open = close - kExposureSeconds;
        const float before = close - kFrameSeconds;
        draw(todo, now, *pipeline, *layout, {.seconds = {close, open, close, before}});
        if (frame > 0) { // the flag as it was, and where it is in this exposure
            draw(todo, last, *pipeline, *layout, {.seconds = {before, open, close, before}});
            inputs.lastDeformedMotion = last.describe(3);
            inputs.followsLast = VK_TRUE;
        }
        const auto done = blur->record(todo, 0, inputs, shutter::BlurSettings("resolved")); // (4)
        require(bool(done), done.message().c_str());
        const vk::ImageSubresourceLayers layers(vk::ImageAspectFlagBits::eColor, 0, 0, 1);
        vk::BufferImageCopy to(0, 0, 0, layers, {}, kSize);
        todo.copyImageToBuffer(*now.images[0].image, kSource, *copies, to);
        to.bufferOffset = kBytes;
        todo.copyImageToBuffer(*output.image, kSource, *copies, to);
        const vk::MemoryBarrier2 shown(kAny, kWrite, vk::PipelineStageFlagBits2::eHost, kRead);
        todo.pipelineBarrier2(vk::DependencyInfo({}, shown));
        todo.end();
        gpu.device.getQueue(0, 0).submit(vk::SubmitInfo({}, {}, todo), *fence);
        (void)gpu.device.waitForFences(*fence, true, UINT64_MAX);
        gpu.device.resetFences(*fence);
    }
    const auto* halves = static_cast<const uint64_t*>(memory.mapMemory(0, VK_WHOLE_SIZE));
    write("before.ppm", halves);
    write("after.ppm", halves + kBytes / 8);

} catch (const std::runtime_error& error) {

    return std::fprintf(stderr, "deforming_host: %s\n", error.what()) > 0;
}
