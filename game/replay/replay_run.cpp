// SPDX-License-Identifier: MIT
#include "game/replay/replay_run.h"

#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "game/output/render_options.h"
#include "game/replay/dump_reader.h"
#include "game/replay/frame_player.h"
#include "modules/motion_blur/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

namespace shutter::replay {

namespace {

using core::makeError;
using motion_blur::MotionBlurSettings;

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

class Player {
  public:
    Player(const ReplayOptions& options, gpu::Device& device, size_t frameCount)
        : mOptions(options), mFrameCount(frameCount),
          mFrames(device, {options.aovs, options.explains, options.showsInputs}) {}

    core::Status create(uint32_t views) { return mFrames.create(views); }

    core::Status play(const DumpFrame& frame) {
        MotionBlurSettings settings = frame.settings;
        if (mOptions.change)
            SHUTTER_TRY(mOptions.change(settings));
        SHUTTER_TRY(checkHeld(frame, settings));
        if (mOptions.explains)
            explain(frame, settings);
        auto picture = mFrames.draw(frame, settings);
        if (!picture)
            return picture.error();
        if (!mOptions.showsInputs)
            compare(frame, settings, picture.value());
        return write(frame, picture.value());
    }

  private:
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
        if (mOptions.out.empty())
            return {};
        const std::filesystem::path file = findFile(frame.name);
        if (const auto written = mFrames.writeIntermediates(frame.name, file); !written)
            return written.error();
        return io::writeImage(file, picture, io::SampleType::Half);
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
    size_t mFrameCount;
    FramePlayer mFrames;
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
