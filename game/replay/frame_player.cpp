// SPDX-License-Identifier: MIT
#include "game/replay/frame_player.h"

#include "engine/core/words.h"
#include "engine/gpu/frame.h"
#include "game/output/extra_files.h"
#include "modules/debug_view/debug_view.h"
#include "modules/motion_blur/embedding/host_blended.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cstring>
#include <utility>

namespace shutter::replay {

namespace {

using core::makeError;
using motion_blur::HostImage;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;

/// Checks that the host's drawing matches the present instants and parts.
core::Status
checkDraws(const DumpFrame& frame, const HostInputs& inputs, const MotionBlurSettings& settings) {
    if (!frame.drawn)
        return {};
    const auto now = motion_blur::describeDrawn(inputs, settings, nullptr).rectangle;
    if (now.instantCount == frame.drawn->instantCount && now.partCount == frame.drawn->partCount)
        return {};
    return makeError(
        "'{}' cannot be replayed by {}: the host drew over it at {} in {}, which are {} and {} now",
        frame.name,
        settings.method->name,
        core::countOf(frame.drawn->instantCount, "instant"),
        core::countOf(frame.drawn->partCount, "part"),
        now.instantCount,
        now.partCount
    );
}

core::Status checkSize(const DumpFrame& frame, const gpu::Device& device) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device.physical(), &properties);
    const uint32_t most = properties.limits.maxImageDimension2D;
    for (const auto& [name, image] : frame.images)
        if (image.width > most || image.height > most)
            return makeError(
                "'{}': the image '{}' of {} x {} is larger than the device's {}",
                frame.name,
                name,
                image.width,
                image.height,
                most
            );
    return {};
}

} // namespace

image::Image unpackPicture(const uint8_t* bytes, uint32_t width, uint32_t height) {
    image::Image picture(width, height, 4);
    picture.channelNames = {"R", "G", "B", "A"};
    for (size_t i = 0; i < size_t{width} * height; ++i) {
        uint64_t texel = 0;
        std::memcpy(&texel, bytes + 8 * i, sizeof(texel));
        const glm::vec4 value = glm::unpackHalf4x16(texel);
        std::memcpy(&picture.pixels[4 * i], &value, sizeof(value));
    }
    return picture;
}

core::Status FramePlayer::create(uint32_t views) {
    motion_blur::HostDevice host;
    host.physical = mDevice.physical();
    host.device = mDevice.handle();
    host.queueFamily = mDevice.queueFamily();
    host.framesInFlight = views;
    host.checksInputs = mOptions.checksInputs;
    host.message = [](std::string_view sentence) { fmt::print("  {}\n", sentence); };
    auto made = motion_blur::EmbeddedMotionBlur::create(host);
    if (!made)
        return made.error();
    mBlur = std::move(made).value();
    return {};
}

HostInputs FramePlayer::describe(const DumpFrame& frame) {
    HostInputs inputs;
    inputs.width = frame.width;
    inputs.height = frame.height;
    inputs.rasterTime = frame.rasterTime;
    inputs.frameNumber = frame.frameNumber;
    inputs.noEntity = frame.noEntity;
    inputs.convention = frame.convention;
    const std::map<std::string, HostImage*> places{
        {"color", &inputs.color},
        {"motionDepth", &inputs.motionDepth},
        {"vectors", &inputs.convention.vectors.image},
        {"depth", &inputs.convention.depth.image},
        {"blurScale", &inputs.convention.scales.perPixel},
        {"normal", &inputs.normal},
        {"entityId", &inputs.entityId},
        {"deformedMotion", &inputs.deformedMotion},
        {"lastDeformedMotion", &inputs.lastDeformedMotion},
        {"blended", &inputs.blended}};
    for (const auto& [name, place] : places)
        if (const DumpImage* image = frame.find(name))
            *place = mUploads.emplace_back(mDevice, *image).describe();
    inputs.motion = frame.motion;
    inputs.motion.view = frame.view;
    inputs.motion.keys = frame.keys;
    mMovers.clear();
    for (size_t i = 0; i < frame.moverRows.size(); ++i)
        mMovers.push_back({frame.moverRows[i], frame.moverMatrices[i]});
    inputs.motion.movers = mMovers;
    inputs.motion.rowIds = frame.rowIds;
    inputs.motion.viewModelRows = frame.viewModelRows;
    inputs.convention.viewModel.viewFromObject = frame.viewFromObject;
    inputs.motion.lens.focusDistances = frame.focusDistances;
    if (frame.reveal == DumpedReveal::Own)
        inputs.reveal = mReveal.answer(frame);
    if (frame.drawn)
        inputs.drawn = mDraws.answer(frame);
    return inputs;
}

core::Status FramePlayer::giveResponse(const DumpFrame& frame, HostInputs& inputs) {
    if (frame.response != DumpedResponse::File)
        return {};
    std::memcpy(&mResponse, frame.responseBytes.data(), sizeof(mResponse));
    if (mResponse.knotCount < 2 || mResponse.knotCount > shader::kMaxResponseKnots)
        return makeError(
            "'{}_response.bin' has {}, it must be 2 to {}",
            frame.name,
            core::countOf(mResponse.knotCount, "knot"),
            shader::kMaxResponseKnots
        );
    for (uint32_t& first : mResponse.firstKnots)
        first = std::min(first, mResponse.knotCount - 2);
    mResponseBuffer = gpu::Buffer(
        mDevice,
        "response",
        sizeof(mResponse),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        gpu::MemoryUse::Stream
    );
    mResponseBuffer.writeBytes(&mResponse, sizeof(mResponse), 0);
    inputs.response = mResponseBuffer.address();
    inputs.motion.response = &mResponse;
    return {};
}

core::Result<image::Image>
FramePlayer::draw(const DumpFrame& frame, const MotionBlurSettings& settings) {
    SHUTTER_TRY(checkSize(frame, mDevice));
    mUploads.clear();
    mReadback.reset();
    mTickets.clear();
    HostInputs inputs = describe(frame);
    if (!settings.method->readsLens)
        inputs.motion.lens = {}; // another method than the host's
    SHUTTER_TRY(giveResponse(frame, inputs));
    SHUTTER_TRY(checkDraws(frame, inputs, settings));
    inputs.showsInputs = mOptions.showsInputs;
    if (!mOptions.aovs.empty())
        inputs.observe = [this](
                             graph::Graph& graph,
                             const motion_blur::MotionBlurInputs& own,
                             const motion_blur::MotionBlurOutputs& made
                         ) { readBack(graph, own, made); };
    const gpu::Image output(
        mDevice,
        "replayed",
        {frame.width,
         frame.height,
         VK_FORMAT_R16G16B16A16_SFLOAT,
         VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
             VK_IMAGE_USAGE_TRANSFER_DST_BIT}
    );
    const gpu::Buffer pixels(
        mDevice,
        "replayed",
        VkDeviceSize{frame.width} * frame.height * 8,
        0,
        gpu::MemoryUse::Readback
    );
    inputs.output = {
        output.handle(),
        {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE},
        kCopied};
    inputs.output.usage = output.desc().usage;
    inputs.output.samples = VK_SAMPLE_COUNT_1_BIT;
    gpu::Frame commands(mDevice);
    commands.begin();
    for (const UploadedImage& upload : mUploads)
        upload.record(commands.commands());
    if (const core::Status done = mBlur->record(commands.commands(), frame.view, inputs, settings);
        !done) {
        commands.submit();
        commands.wait();
        return makeError("'{}': {}", frame.name, done.error().message);
    }
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {frame.width, frame.height, 1};
    vkCmdCopyImageToBuffer(
        commands.commands(), output.handle(), kCopied.layout, pixels.handle(), 1, &region
    );
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands.commands(), &dependency);
    commands.submit();
    commands.wait();
    SHUTTER_TRY(mBlur->markDone(frame.view));
    return unpackPicture(static_cast<const uint8_t*>(pixels.mapped()), frame.width, frame.height);
}

/// Copies the intermediates that are wanted to where the CPU reads them.
void FramePlayer::readBack(
    graph::Graph& graph,
    const motion_blur::MotionBlurInputs& own,
    const motion_blur::MotionBlurOutputs& made
) {
    std::map<std::string, graph::ImageHandle> known{
        {"motion", own.motionDepth},
        {"depth", own.motionDepth},
        {"normal", own.normal},
        {"mesh_id", own.entityId}};
    for (const motion_blur::View& view : made.views)
        known[std::string(view.name)] = view.image;
    std::erase_if(known, [](const auto& one) {
        const auto* view = debug_view::findView(one.first);
        return !one.second.isValid() || !view || view->channels.empty();
    });
    mKnown.clear();
    for (const auto& [name, handle] : known)
        mKnown.push_back(name);
    for (const auto& [name, handle] : known)
        if (mOptions.aovs.front() == "all" ||
            std::find(mOptions.aovs.begin(), mOptions.aovs.end(), name) != mOptions.aovs.end())
            mTickets[name] = mReadback.add(graph, name, handle);
}

core::Result<std::vector<std::filesystem::path>> FramePlayer::writeIntermediates(
    const std::string& frame, const std::filesystem::path& picture
) const {
    for (const std::string& wanted : mOptions.aovs)
        if (wanted != "all" && !mTickets.contains(wanted))
            return makeError(
                "--aov '{}' is nothing that '{}' has, which has {}",
                wanted,
                frame,
                fmt::join(mKnown, ", ")
            );
    std::vector<std::filesystem::path> files;
    for (const auto& [name, ticket] : mTickets) {
        files.push_back(game::intermediateFile(picture, name));
        SHUTTER_TRY(game::writeIntermediate(files.back(), name, mReadback.take(ticket)));
    }
    return files;
}

} // namespace shutter::replay
