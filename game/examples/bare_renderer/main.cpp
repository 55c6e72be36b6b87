// SPDX-License-Identifier: MIT
// Motion blur in a renderer that has its own device, images, commands and two frames in flight:
// from a moving square, before which a spark flies, to "before.ppm" (without the spark) and
// "after.ppm". Shutter's part is marked (1) to (4).
#include <glm/gtc/packing.hpp>
#include <shutter_motion_blur.hpp>
#include <vulkan/vulkan_raii.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <vector>

constexpr uint32_t kWidth = 320, kHeight = 180, kInFlight = 2, kFrames = 5;
constexpr float kSpeedPx = 24; // of the square, in a frame; its exposure is as long
constexpr vk::Extent3D kSize(kWidth, kHeight, 1);
constexpr vk::DeviceSize kBytes = kWidth * kHeight * 8; // of a picture in half floats
constexpr auto kHalf = vk::Format::eR16G16B16A16Sfloat, kFull = vk::Format::eR32G32B32A32Sfloat;
constexpr auto kTarget = vk::ImageLayout::eColorAttachmentOptimal;
constexpr auto kSource = vk::ImageLayout::eTransferSrcOptimal;
constexpr auto kAny = vk::PipelineStageFlagBits2::eAllCommands;
constexpr auto kWrite = vk::AccessFlagBits2::eMemoryWrite, kRead = vk::AccessFlagBits2::eHostRead;
constexpr auto kColor = vk::ImageAspectFlagBits::eColor;

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

    Image(const Gpu& gpu, vk::Format format, vk::ImageUsageFlags usage) {
        vk::ImageCreateInfo info({}, vk::ImageType::e2D, format, kSize, 1, 1);
        info.usage = usage | vk::ImageUsageFlagBits::eColorAttachment;
        image = vk::raii::Image(gpu.device, info);
        memory = gpu.allocate(image.getMemoryRequirements(), {});
        image.bindMemory(*memory, 0);
        view = {gpu.device, {{}, *image, vk::ImageViewType::e2D, format, {}, {kColor, 0, 1, 0, 1}}};
    }
};

using Images = std::array<const Image*, 3>; // opaque colour; its motion and depth; blended surfaces

/// Clears rectangles: stripes at rest, 10 m away, the square at 5 m; the spark is blended.
void draw(const vk::raii::CommandBuffer& commands, const Images& images, int x) {
    std::array<vk::RenderingAttachmentInfo, 3> targets;
    std::array<vk::ImageMemoryBarrier2, 3> barriers;
    for (const size_t i : {0, 1, 2}) {
        barriers[i].setSrcStageMask(kAny).setDstStageMask(kAny).setDstAccessMask(kWrite);
        barriers[i].setNewLayout(kTarget).setImage(*images[i]->image);
        barriers[i].setSubresourceRange({kColor, 0, 1, 0, 1});
        targets[i].setImageView(*images[i]->view).setImageLayout(kTarget);
        targets[i].setLoadOp(vk::AttachmentLoadOp::eClear);
    }
    commands.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, barriers));
    commands.beginRendering(vk::RenderingInfo({}, {{}, {kWidth, kHeight}}, 1, 0, targets));
    const auto fill = [&](vk::Rect2D area, std::array<float, 4> rgba, std::array<float, 4> moved) {
        const vk::ClearAttachment first(kColor, 0, vk::ClearColorValue(rgba));
        const vk::ClearAttachment second(kColor, 1, vk::ClearColorValue(moved));
        commands.clearAttachments({first, second}, vk::ClearRect(area, 0, 1));
    };
    for (int left = 0; left < int(kWidth); left += 10)
        fill({{left, 0}, {10, kHeight}}, {left % 20 ? 0.1f : 0.5f, 0.3f, 0.4f, 1}, {0, 0, 10, 0});
    fill({{x, 60}, {60, 60}}, {1, 0.3f, 0.1f, 1}, {kSpeedPx, 0, 5, 0});
    // Over the exposure: 6 px wide, it covers each column for a share of the time, with an opacity
    // of one half.
    for (int i = 0; i < int(kSpeedPx) + 6; ++i) {
        const float share = float(std::min({i + 1, 6, int(kSpeedPx) + 6 - i})) / kSpeedPx;
        const std::array premultiplied{share, share, share, 0.5f * share};
        const vk::ClearAttachment spark(kColor, 2, vk::ClearColorValue(premultiplied));
        commands.clearAttachments(spark, vk::ClearRect({{x + i, 70}, {1, 6}}, 0, 1));
    }
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
    const vk::raii::CommandPool pool(gpu.device, {{}, 0});
    const vk::raii::CommandBuffers commands(gpu.device, {*pool, {}, kFrames});
    std::vector<vk::raii::Fence> fences;
    using enum vk::ImageUsageFlagBits;
    const Image color(gpu, kHalf, eSampled | eTransferSrc), motion(gpu, kFull, eSampled);
    const Image blended(gpu, kHalf, eSampled);
    const Image output(gpu, kHalf, eStorage | eTransferDst | eTransferSrc);
    constexpr auto kTo = vk::BufferUsageFlagBits::eTransferDst;
    vk::raii::Buffer copies(gpu.device, {{}, 2 * kFrames * kBytes, kTo});
    using enum vk::MemoryPropertyFlagBits;
    const auto memory = gpu.allocate(copies.getMemoryRequirements(), eHostVisible | eHostCoherent);
    copies.bindMemory(*memory, 0);
    auto blur = shutter::MotionBlur::create({*physical, *gpu.device, 0, kInFlight}); // (2) once
    require(bool(blur), blur.message().c_str());
    shutter::BlurInputs inputs(kWidth, kHeight); // (3) its inputs and outputs
    inputs.color = shutter::BlurImage(*color.image, VkImageLayout(kTarget), VkImageLayout(kSource));
    inputs.motionDepth = shutter::BlurImage(*motion.image, VkImageLayout(kTarget), {});
    inputs.blended = shutter::BlurImage(*blended.image, VkImageLayout(kTarget), {});
    inputs.output = shutter::BlurImage(*output.image, {}, VkImageLayout(kSource));
    const shutter::BlurSettings kGather("gather");
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        if (frame >= kInFlight) // (4) is given the number of a frame that the GPU is done with
            (void)gpu.device.waitForFences(*fences[frame - kInFlight], true, UINT64_MAX);
        const vk::raii::CommandBuffer& now = commands[frame];
        now.begin({});
        draw(now, {&color, &motion, &blended}, 40 + int(kSpeedPx * float(frame)));
        const auto done = blur->record(*now, frame % kInFlight, inputs, kGather);
        require(bool(done), done.message().c_str());
        vk::BufferImageCopy to(2 * frame * kBytes, 0, 0, {kColor, 0, 0, 1}, {}, kSize);
        now.copyImageToBuffer(*color.image, kSource, *copies, to);
        to.bufferOffset += kBytes;
        now.copyImageToBuffer(*output.image, kSource, *copies, to);
        const vk::MemoryBarrier2 shown(kAny, kWrite, vk::PipelineStageFlagBits2::eHost, kRead);
        now.pipelineBarrier2(vk::DependencyInfo({}, shown));
        now.end();
        fences.emplace_back(gpu.device, vk::FenceCreateInfo());
        gpu.device.getQueue(0, 0).submit(vk::SubmitInfo({}, {}, *now), *fences[frame]);
    }
    gpu.device.waitIdle();
    const auto* halves = static_cast<const uint64_t*>(memory.mapMemory(0, VK_WHOLE_SIZE));
    write("before.ppm", halves + (2 * kFrames - 2) * kBytes / 8);
    write("after.ppm", halves + (2 * kFrames - 1) * kBytes / 8);

} catch (const std::runtime_error& error) {

    return std::fprintf(stderr, "bare_renderer: %s\n", error.what()) > 0;
}
