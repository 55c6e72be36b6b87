// SPDX-License-Identifier: MIT
#include "game/replay/replay_run.h"

#include "engine/core/words.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "engine/render/readback.h"
#include "game/output/extra_files.h"
#include "game/output/render_options.h"
#include "game/replay/dump_on_device.h"
#include "game/replay/dump_reader.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/embedding/host_blended.h"
#include "modules/motion_blur/methods.h"
#include "shaders/common/shutter_response_shared.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace shutter::replay {

namespace {

using core::makeError;
using motion_blur::HostImage;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;

/// RGBA of half floats.
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

/// Checks that the dump has the method's inputs.
core::Status checkHeld(const DumpFrame& frame, const MotionBlurSettings& settings) {
    const motion_blur::Method& method = *settings.method;
    const std::string_view dumped = frame.settings.method->name;
    if (!method.readsRaster || method.rays == motion_blur::RayNeed::Query)
        return makeError("--method {} needs the scene, which no dump holds", method.name);
    if (method.readsCamera && !frame.convention.cameras.areGiven)
        return makeError(
            "'{}' cannot be replayed by {}: the dump holds no cameras, since the host gave none",
            frame.name,
            method.name
        );
    if (method.rays == motion_blur::RayNeed::Any && frame.reveal != DumpedReveal::Own)
        return makeError(
            "'{}' cannot be replayed by {}: the dump holds nothing of what lies behind, since the "
            "host {}",
            frame.name,
            method.name,
            frame.reveal == DumpedReveal::Tables ? "have Shutter trace its own scene tables"
                                                 : fmt::format("ran {}", dumped)
        );
    if (method.readsInstantMotions && !frame.hasMotion)
        return makeError(
            "'{}' cannot be replayed by {}: the dump holds no camera keys, since the host ran {}",
            frame.name,
            method.name,
            dumped
        );
    // Where nothing moves by itself, a host need not have ids.
    const bool readsIds =
        method.readsEntityId && !(method.readsInstantMotions && frame.moverRows.empty());
    for (const char* name : {"normal", "entityId"})
        if ((std::string_view(name) == "normal" ? method.readsNormal : readsIds) &&
            !frame.find(name))
            return makeError(
                "'{}' cannot be replayed by {}: the dump holds no {}", frame.name, method.name, name
            );
    if (frame.response == DumpedResponse::Address)
        return makeError(
            "'{}' cannot be replayed: the host gave its shutter response by address alone; with "
            "motion.response, the dump holds it",
            frame.name
        );
    return {};
}

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

class Player {
  public:
    Player(const ReplayOptions& options, gpu::Device& device, size_t frameCount)
        : mOptions(options), mDevice(device), mFrameCount(frameCount), mReveal(device),
          mDraws(device), mReadback(device) {}

    core::Status create(uint32_t views) {
        motion_blur::HostDevice host;
        host.physical = mDevice.physical();
        host.device = mDevice.handle();
        host.queueFamily = mDevice.queueFamily();
        host.framesInFlight = views;
        host.checksInputs = mOptions.explains;
        host.message = [](std::string_view sentence) { fmt::print("  {}\n", sentence); };
        auto made = motion_blur::EmbeddedMotionBlur::create(host);
        if (!made)
            return made.error();
        mBlur = std::move(made).value();
        return {};
    }

    core::Status play(const DumpFrame& frame) {
        MotionBlurSettings settings = frame.settings;
        if (mOptions.change)
            SHUTTER_TRY(mOptions.change(settings));
        SHUTTER_TRY(checkHeld(frame, settings));
        SHUTTER_TRY(checkSize(frame, mDevice));
        if (mOptions.explains)
            explain(frame, settings);
        auto picture = draw(frame, settings);
        if (!picture)
            return picture.error();
        if (!mOptions.showsInputs)
            compare(frame, settings, picture.value());
        return write(frame, picture.value());
    }

  private:
    HostInputs describe(const DumpFrame& frame) {
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

    core::Status giveResponse(const DumpFrame& frame, HostInputs& inputs) {
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

    core::Result<image::Image> draw(const DumpFrame& frame, const MotionBlurSettings& settings) {
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
             VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}
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
        if (const core::Status done =
                mBlur->record(commands.commands(), frame.view, inputs, settings);
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
        return unpackPicture(
            static_cast<const uint8_t*>(pixels.mapped()), frame.width, frame.height
        );
    }

    /// Copies the intermediates that are wanted to where the CPU reads them.
    void readBack(
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

    void explain(const DumpFrame& frame, const MotionBlurSettings& settings) const {
        const auto yes = [](bool is, const char* what) { return is ? what : ""; };
        fmt::print(
            "{}: {} x {}, view {}, {}{}{}{}{}\n",
            frame.name,
            frame.width,
            frame.height,
            frame.view,
            settings.method->name,
            yes(settings.method != frame.settings.method, ", which the host did not run"),
            frame.find("motionDepth") ? ", motion and depth as the host gave them"
                                      : ", motion and depth made of the host's own",
            yes(frame.motion.followsLast && settings.history &&
                    settings.method->readsInstantMotions,
                ", looks up the previous frame"),
            yes(frame.motion.lens.isOpen() && settings.method->readsLens, ", through a lens")
        );
        for (const auto& row : motion_blur::listSettingRows()) {
            const auto& used = settings.method->settings;
            if (std::find(used.begin(), used.end(), row.name) == used.end())
                continue;
            const std::string now = core::describeValue(row, settings);
            const std::string then = core::describeValue(row, frame.settings);
            fmt::print(
                "  {}={}{}\n", row.name, now, now == then ? "" : fmt::format(" (was {})", then)
            );
        }
        for (const auto& [name, image] : frame.images)
            fmt::print(
                "  {}: {} x {} at {}, {} of {} x {}\n",
                name,
                image.area.extent.width,
                image.area.extent.height,
                image.area.offset.x,
                image.area.offset.y,
                image.width,
                image.height
            );
        if (frame.reveal == DumpedReveal::Own && settings != frame.settings)
            fmt::print("  where pixels need an answer that the host did not give, the reveal is "
                       "undefined\n");
    }

    void compare(
        const DumpFrame& frame, const MotionBlurSettings& settings, const image::Image& picture
    ) const {
        const image::Image host =
            unpackPicture(frame.find("picture")->bytes.data(), frame.width, frame.height);
        const bool isSame =
            std::memcmp(
                host.pixels.data(), picture.pixels.data(), host.pixels.size() * sizeof(float)
            ) == 0;
        fmt::print(
            "{}: {}: {}\n",
            frame.name,
            settings.method->name,
            isSame ? "the host's picture, bit for bit"
                   : fmt::format(
                         "{:.2f} dB from the host's picture", image::computePsnr(host, picture)
                     )
        );
    }

    core::Status write(const DumpFrame& frame, const image::Image& picture) const {
        for (const std::string& wanted : mOptions.aovs)
            if (wanted != "all" && !mTickets.contains(wanted))
                return makeError(
                    "--aov '{}' is nothing that '{}' has, which has {}",
                    wanted,
                    frame.name,
                    fmt::join(mKnown, ", ")
                );
        if (mOptions.out.empty())
            return {};
        const std::filesystem::path file = findFile(frame.name);
        SHUTTER_TRY(io::writeImage(file, picture, io::SampleType::Half));
        for (const auto& [name, ticket] : mTickets)
            SHUTTER_TRY(game::writeIntermediate(
                game::intermediateFile(file, name), name, mReadback.take(ticket)
            ));
        return {};
    }

    /// The picture's file, by the number in the name of the dump's file, frame_NNNN.
    [[nodiscard]] std::filesystem::path findFile(const std::string& name) const {
        const std::string number = name.substr(std::strlen("frame_"));
        std::filesystem::path file = game::frameFile(mOptions.out, std::stoi(number));
        const bool isNumbered = file != game::frameFile(mOptions.out, -1);
        if (mFrameCount > 1 && !isNumbered)
            file.replace_filename(file.stem().string() + "_" + number + file.extension().string());
        return file;
    }

    const ReplayOptions& mOptions;
    gpu::Device& mDevice;
    size_t mFrameCount;
    std::unique_ptr<motion_blur::EmbeddedMotionBlur> mBlur;
    std::deque<UploadedImage> mUploads;
    std::vector<motion_blur::HostMover> mMovers;
    ReplayedReveal mReveal;
    ReplayedDraws mDraws;
    shader::ResponseTable mResponse{};
    gpu::Buffer mResponseBuffer;
    render::Readback mReadback;
    std::map<std::string, size_t> mTickets;
    std::vector<std::string> mKnown; ///< names of the frame's intermediates
};

} // namespace

core::Status replay(const ReplayOptions& options, gpu::Device& device) {
    const auto files = listDumpFrames(options.folder);
    if (!files)
        return files.error();
    // All manifests first: report a broken one before anything is written.
    std::vector<DumpFrame> frames;
    uint32_t views = 1;
    for (const auto& file : files.value()) {
        auto frame = readDumpManifest(file);
        if (!frame)
            return frame.error();
        views = std::max(views, frame.value().view + 1);
        frames.push_back(std::move(frame).value());
    }
    Player player(options, device, frames.size());
    SHUTTER_TRY(player.create(views));
    for (DumpFrame& frame : frames) {
        SHUTTER_TRY(readDumpTexels(options.folder, frame));
        SHUTTER_TRY(player.play(frame));
        frame = {};
    }
    return {};
}

} // namespace shutter::replay
