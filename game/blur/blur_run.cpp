// SPDX-License-Identifier: MIT
#include "game/blur/blur_run.h"

#include "engine/core/progress.h"
#include "engine/core/words.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "game/output/extra_files.h"
#include "game/output/render_options.h"
#include "game/output/sequence_journal.h"
#include "game/replay/frame_player.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

namespace shutter::blur {

namespace {

using core::makeError;
using core::Status;
namespace fs = std::filesystem;

PassFiles filesOf(const BlurOptions& options, int frame) {
    const auto find = [&](const fs::path& file) {
        return options.isSequence ? game::frameFile(file, frame) : file;
    };
    const PassFiles& files = options.files;
    return {find(files.color), find(files.motion), find(files.depth), find(files.ids)};
}

/// What the frames depend on. Error: a file is not there, before any frame is drawn.
core::Result<std::string> findFingerprint(const BlurOptions& options, const gpu::Device& device) {
    auto program = io::computeFileHash("/proc/self/exe");
    if (!program)
        return program.error();
    std::string text = fmt::format(
        "{} program {} device {} {}",
        options.fingerprint,
        program.value(),
        device.info().name,
        device.info().driver
    );
    if (!options.cameras.empty()) {
        auto cameras = io::computeFileHash(options.cameras);
        if (!cameras)
            return cameras.error();
        text += cameras.value();
    }
    for (int frame = options.firstFrame; frame <= options.lastFrame; ++frame) {
        const PassFiles files = filesOf(options, frame);
        for (const fs::path& file : {files.color, files.motion, files.depth, files.ids}) {
            if (file.empty())
                continue;
            std::error_code error;
            const auto size = fs::file_size(file, error);
            const auto time = error ? fs::file_time_type() : fs::last_write_time(file, error);
            if (error)
                return makeError("'{}' cannot be read: {}", file.string(), error.message());
            text += fmt::format(" {} {}", size, time.time_since_epoch().count());
        }
    }
    return io::computeContentHash(text);
}

class Blurring {
  public:
    Blurring(const BlurOptions& options, gpu::Device& device)
        : mOptions(options), mPlayer(device, {options.aovs}), mAlphaPlayer(device, {}) {}

    Status open(const std::string& fingerprint) {
        SHUTTER_TRY(mPlayer.create(1));
        if (game::frameFile(mOptions.out, 0) == game::frameFile(mOptions.out, 1))
            return {};
        auto journal = game::SequenceJournal::open(game::journalFile(mOptions.out), fingerprint);
        if (!journal)
            return journal.error();
        mJournal = std::move(journal).value();
        return {};
    }

    Status run() {
        const int count = mOptions.lastFrame - mOptions.firstFrame + 1;
        core::Progress progress("rendering", uint64_t(count));
        if (mOptions.isSequence)
            progress.printLines();
        int skipped = 0;
        for (int frame = mOptions.firstFrame; frame <= mOptions.lastFrame; ++frame) {
            if (isComplete(frame)) {
                ++skipped;
            } else {
                // What a run without a stop would have seen of the frame before.
                if (frame > mOptions.firstFrame && mLast != frame - 1 && looksBack())
                    if (const auto drawn = draw(frame - 1); !drawn)
                        return drawn.error();
                SHUTTER_TRY(write(frame));
            }
            progress.advance();
        }
        if (skipped > 0)
            fmt::print(
                "{}: {} of {} complete on disk and skipped (--restart draws them)\n",
                mOptions.out.string(),
                skipped,
                core::countOf(uint64_t(count), "frame is", "frames are")
            );
        return {};
    }

  private:
    [[nodiscard]] bool isComplete(int frame) const {
        return mJournal && !mOptions.restart &&
               mJournal->isComplete(frame, game::frameFile(mOptions.out, frame));
    }

    [[nodiscard]] bool looksBack() const {
        return mOptions.settings.method->readsInstantMotions && mOptions.settings.history;
    }

    /// \return RGB, and alpha where the picture has it
    core::Result<image::Image> draw(int number) {
        auto passes = readPasses(filesOf(mOptions, number), mOptions.passes);
        if (!passes)
            return passes.error();
        mIsDisplayEncoded = passes.value().isDisplayEncoded;
        std::optional<Cameras> cameras;
        if (!mOptions.cameras.empty()) {
            auto read =
                readCameras(mOptions.cameras, double(passes.value().width) / passes.value().height);
            if (!read)
                return read.error();
            cameras = std::move(read).value();
        }
        auto frame = makeFrame(
            passes.value(),
            cameras ? &*cameras : nullptr,
            mOptions.shutter,
            mOptions.settings,
            number,
            mLast == number - 1
        );
        if (!frame)
            return makeError("'{}': {}", mOptions.cameras.string(), frame.error().message);
        auto picture = mPlayer.draw(frame.value(), mOptions.settings);
        if (!picture)
            return picture;
        const std::vector<glm::vec4>& color = passes.value().color;
        if (std::any_of(color.begin(), color.end(), [](const auto& one) { return one.a != 1.0f; }))
            SHUTTER_TRY(drawAlpha(frame.value(), passes.value(), picture.value()));
        mLast = number;
        constexpr std::array<game::Channel, 4> kRgba{{{0, "R"}, {1, "G"}, {2, "B"}, {3, "A"}}};
        return game::selectChannels(
            picture.value(), std::span(kRgba).first(passes.value().hasAlpha ? 4 : 3)
        );
    }

    /// Alpha is blurred as another colour, since methods leave it out.
    Status drawAlpha(replay::DumpFrame& frame, const Passes& passes, image::Image& picture) {
        if (!mLastAlpha)
            SHUTTER_TRY(mAlphaPlayer.create(1));
        showAlpha(frame, passes);
        const auto number = int(frame.frameNumber);
        frame.motion.followsLast = std::exchange(mLastAlpha, number) == number - 1;
        const auto alpha = mAlphaPlayer.draw(frame, mOptions.settings);
        if (!alpha)
            return alpha.error();
        for (size_t i = 3; i < picture.pixels.size(); i += 4)
            picture.pixels[i] = alpha.value().pixels[i - 3];
        return {};
    }

    Status write(int number) {
        auto picture = draw(number);
        if (!picture)
            return picture.error();
        const fs::path file =
            mOptions.isSequence ? game::frameFile(mOptions.out, number) : mOptions.out;
        const auto display = io::isDisplayFormat(file);
        if (!display)
            return display.error();
        if (display.value()) {
            tonemap::TonemapSettings tonemap = mOptions.tonemap;
            if (mIsDisplayEncoded)
                tonemap.op = tonemap::Operator::None;
            constexpr std::array<game::Channel, 3> kRgb{{{0, "R"}, {1, "G"}, {2, "B"}}};
            picture =
                tonemap::computeDisplayImage(game::selectChannels(picture.value(), kRgb), tonemap);
        }
        auto files = mPlayer.writeIntermediates(fmt::format("frame {}", number), file);
        if (!files)
            return files.error();
        SHUTTER_TRY(io::writeImage(file, picture.value()));
        files.value().push_back(file);
        return mJournal ? mJournal->add(number, files.value()) : Status();
    }

    const BlurOptions& mOptions;
    replay::FramePlayer mPlayer;
    replay::FramePlayer mAlphaPlayer;
    bool mIsDisplayEncoded = false; ///< the last picture
    std::optional<int> mLast;       ///< the frame drawn last
    std::optional<int> mLastAlpha;
    std::optional<game::SequenceJournal> mJournal;
};

} // namespace

Status blur(const BlurOptions& options, gpu::Device& device) {
    const auto fingerprint = findFingerprint(options, device);
    if (!fingerprint)
        return fingerprint.error();
    Blurring blurring(options, device);
    SHUTTER_TRY(blurring.open(fingerprint.value()));
    return blurring.run();
}

} // namespace shutter::blur
