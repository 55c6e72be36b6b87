// SPDX-License-Identifier: MIT
#include "engine/core/log.h"
#include "engine/core/whole_file.h"
#include "game/output/render_options.h"
#include "game/output/sequence.h"

#include <string>
#include <system_error>

namespace shutter::game {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPattern = "frame_%06d.png";

/// Resolves the film's encoding: the time code in numbers. Error: names --timecode.
core::Result<io::VideoFormat> resolveFormat(const RenderOptions& options) {
    io::VideoFormat format = options.output.video;
    const auto timecode = findTimecode(options, 0);
    if (!timecode)
        return timecode.error();
    if (timecode.value())
        format.timecode = describe(*timecode.value());
    return format;
}

} // namespace

fs::path filmFrames(const fs::path& film) {
    return fs::path(film.string() + ".frames") / kPattern;
}

core::Result<io::VideoEncoder> prepareFilm(const RenderOptions& options) {
    if (const core::Status able = io::checkFilmWritable(options.output.film); !able)
        return core::makeError("--out: {}", able.error().message);
    const auto format = resolveFormat(options);
    if (!format)
        return format.error();
    auto encoder = io::findVideoEncoder(options.output.ffmpeg, format.value());
    if (!encoder)
        return core::makeError(
            "{}: {}", options.output.ffmpeg.empty() ? "--out" : "--ffmpeg", encoder.error().message
        );
    return encoder;
}

core::Status makeFilmFolder(const RenderOptions& options) {
    std::error_code failure;
    const fs::path folder = options.output.out.parent_path();
    fs::create_directory(folder, failure);
    if (failure || !fs::is_directory(folder, failure))
        return core::makeError(
            "--out: cannot make the folder '{}': {}", folder.string(), failure.message()
        );
    return {};
}

core::Status encodeFilm(const io::VideoEncoder& encoder, const RenderOptions& options) {
    io::VideoFrames frames;
    frames.folder = options.output.out.parent_path();
    frames.pattern = kPattern;
    frames.count = uint32_t(options.shot.frameTimes.size());
    frames.framesPerSecond = options.shot.fps;
    if (core::Status encoded = io::encodeVideo(encoder, frames, options.output.film); !encoded)
        return core::makeError("--out: {}", encoded.error().message);
    return {};
}

void removeFilmFrames(const RenderOptions& options, const fs::path& framesJournal) {
    if (options.output.keepFrames)
        return;
    std::error_code ignored;
    const fs::path folder = options.output.out.parent_path();
    for (size_t i = 0; i < options.shot.frameTimes.size(); ++i)
        fs::remove(frameFile(options.output.out, int(i)), ignored);
    fs::remove(framesJournal, ignored);
    core::removeTemporaryFiles(folder);
    fs::remove(folder, ignored);
    if (fs::exists(folder, ignored))
        core::logWarning("'{}' holds other files and is kept", folder.string());
}

} // namespace shutter::game
