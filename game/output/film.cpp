// SPDX-License-Identifier: MIT
#include "engine/core/log.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "game/output/sequence.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>
#include <vector>

namespace shutter::game {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPattern = "frame_%06d.png";

/// What the film is encoded as: the time code in numbers. Error: names --timecode.
core::Result<io::VideoFormat> resolveFormat(const RenderOptions& options) {
    io::VideoFormat format = options.output.video;
    if (format.timecode.empty())
        return format;
    const long rate = std::max(1L, std::lround(options.shot.fps));
    if (format.timecode == kTimecodeOfFrame) {
        const long frame = options.shot.firstFrame;
        const long second = frame / rate;
        if (frame < 0 || second >= 100 * 3600)
            return core::makeError("--timecode frame: frame {} has none", frame);
        format.timecode = fmt::format(
            "{:02}:{:02}:{:02}:{:02}", second / 3600, second / 60 % 60, second % 60, frame % rate
        );
    }
    if (std::stol(format.timecode.substr(format.timecode.rfind(':') + 1)) >= rate)
        return core::makeError(
            "--timecode {}: a second has {} frames, numbered from 0", format.timecode, rate
        );
    return format;
}

} // namespace

fs::path filmFrames(const fs::path& film) {
    return fs::path(film.string() + ".frames") / kPattern;
}

core::Result<io::VideoEncoder> prepareFilm(const RenderOptions& options) {
    std::error_code ignored;
    if (fs::is_directory(options.output.film, ignored))
        return core::makeError(
            "--out: cannot write '{}': it is a folder", options.output.film.string()
        );
    // Checked with the name of a picture: only the folder matters.
    const fs::path folder =
        options.output.film.has_parent_path() ? options.output.film.parent_path() : ".";
    if (core::Status writable = io::checkWritable(folder / "frame.png"); !writable)
        return core::makeError(
            "--out: cannot write '{}': the folder '{}' does not exist or cannot be written",
            options.output.film.string(),
            folder.string()
        );
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
    std::vector<fs::path> left;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().filename().string().starts_with(io::kTemporaryPrefix))
            left.push_back(entry.path()); // of a run that was killed
    for (const fs::path& file : left)
        fs::remove(file, ignored);
    fs::remove(folder, ignored);
    if (fs::exists(folder, ignored))
        core::logWarning("'{}' holds other files and is kept", folder.string());
}

} // namespace shutter::game
