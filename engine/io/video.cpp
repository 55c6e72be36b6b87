// SPDX-License-Identifier: MIT
#include "engine/io/video.h"

#include "engine/core/whole_file.h"
#include "engine/io/image_file.h"
#include "engine/io/process.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

namespace shutter::io {

namespace fs = std::filesystem;

namespace {

std::string_view findFirstLine(std::string_view text) {
    return text.substr(0, text.find('\n'));
}

/// That holds anything.
std::string_view findLastLine(std::string_view text) {
    const size_t end = text.find_last_not_of(" \r\n");
    if (end == std::string_view::npos)
        return "it gave no reason";
    text = text.substr(0, end + 1);
    const size_t start = text.rfind('\n');
    return start == std::string_view::npos ? text : text.substr(start + 1);
}

struct CodecRow {
    VideoCodec codec;
    uint32_t bitDepth;
    const char* name; ///< ffmpeg's; of rows of equal codec and depth the first that it has is taken
    const char* pixelFormat;
    std::vector<std::string> options;
};

const std::vector<CodecRow>& listCodecs() {
    static const std::vector<std::string> kH264 = {"-preset", "medium", "-crf", "16"};
    static const std::vector<std::string> kAv1 = {"-crf", "20", "-b:v", "0", "-cpu-used", "6"};
    // A key frame is at most eight frames before any that a viewer steps to.
    static const std::vector<std::string> kVp9 = {"-g", "8", "-deadline", "good", "-cpu-used", "4"};
    static const std::vector<CodecRow> kRows = {
        {VideoCodec::H264, 8, "libx264", "yuv420p", kH264},
        {VideoCodec::H264, 8, "mpeg4", "yuv420p", {"-q:v", "2"}},
        {VideoCodec::H264, 10, "libx264", "yuv420p10le", kH264},
        {VideoCodec::Av1, 8, "libaom-av1", "yuv420p", kAv1},
        {VideoCodec::Av1, 10, "libaom-av1", "yuv420p10le", kAv1},
        {VideoCodec::ProRes, 10, "prores_ks", "yuv422p10le", {"-profile:v", "hq"}},
        {VideoCodec::Vp9, 8, "libvpx-vp9", "yuv420p", kVp9},
    };
    return kRows;
}

bool isOfFormat(const CodecRow& row, const VideoFormat& format) {
    return row.codec == format.codec && row.bitDepth == format.bitDepth;
}

const CodecRow& findCodec(const VideoEncoder& encoder) {
    const auto row =
        std::find_if(listCodecs().begin(), listCodecs().end(), [&](const CodecRow& each) {
            return isOfFormat(each, encoder.format) && encoder.codec == each.name;
        });
    SHUTTER_CHECK(row != listCodecs().end(), "no codec '{}'", encoder.codec);
    return *row;
}

/// By the file's name: .mov or .webm, else .mp4.
const char* findContainer(const fs::path& file) {
    const std::string extension = lowerExtension(file);
    if (extension == ".webm")
        return "webm";
    return extension == ".mov" ? "mov" : "mp4";
}

/// libvpx does not keep to a largest rate alone: films of two seconds came out six times as large.
std::vector<std::string> listRateArguments(uint32_t kilobits) {
    if (kilobits == 0)
        return {"-crf", "12", "-b:v", "0"};
    const std::string rate = fmt::format("{}k", kilobits);
    return {"-b:v", rate, "-minrate", rate, "-maxrate", rate, "-bufsize", rate};
}

std::vector<std::string> listArguments(
    const VideoEncoder& encoder,
    const VideoFrames& frames,
    const char* container,
    const fs::path& target
) {
    const CodecRow& codec = findCodec(encoder);
    // Without -xerror a full disk and a damaged frame end with status 0.
    std::vector<std::string> words = {
        "-nostdin", "-hide_banner", "-loglevel", "error", "-xerror", "-y"};
    const auto add = [&](const std::vector<std::string>& more) {
        words.insert(words.end(), more.begin(), more.end());
    };
    add({"-framerate", core::describe(frames.framesPerSecond), "-start_number", "0"});
    add({"-i", frames.pattern, "-frames:v", fmt::format("{}", frames.count), "-an"});
    add({"-c:v", codec.name});
    add(codec.options);
    if (codec.codec == VideoCodec::Vp9)
        add(listRateArguments(encoder.format.kilobits));
    // Players take the matrix of BT.709 for granted; swscale's own default is BT.601's.
    add(
        {"-vf",
         std::string("scale=out_color_matrix=bt709:out_range=tv:"
                     "flags=bicubic+accurate_rnd+full_chroma_int+bitexact,format="
         ) + codec.pixelFormat,
         "-colorspace",
         "bt709",
         "-color_primaries",
         "bt709",
         "-color_trc",
         "bt709",
         "-color_range",
         "tv"}
    );
    // Makes output bit-exact on every machine: slices and version strings would differ.
    add({"-threads", "1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1"});
    if (!encoder.format.timecode.empty())
        add({"-timecode", encoder.format.timecode});
    // The protocol in front, or a name with a colon would be taken for one.
    if (container != std::string_view("webm"))
        add({"-movflags", "+faststart"});
    add({"-f", container, "file:" + target.string()});
    return words;
}

/// The file that becomes the film, links followed. Error: names the file and why.
core::Result<fs::path> findFilmPlace(const fs::path& file) {
    const auto fail = [&](std::string_view why) {
        return core::makeError("cannot write '{}': {}", file.string(), why);
    };
    if (const core::Status able = core::checkOutput(file); !able)
        return fail(able.error().message);
    const auto place = core::findOutputPlace(file);
    if (!place)
        return fail(place.error().message);
    if (place.value().isStream) // the encoder goes back to the file's beginning
        return fail("it is a pipe or a device, and a film needs a file");
    return place.value().path;
}

std::optional<fs::path> findMissingFrame(const VideoFrames& frames) {
    std::error_code ignored;
    for (uint32_t i = 0; i < frames.count; ++i) {
        std::array<char, 256> name{};
        std::snprintf(name.data(), name.size(), frames.pattern.c_str(), int(i));
        const fs::path file = frames.folder / name.data();
        if (!fs::is_regular_file(file, ignored))
            return file;
    }
    return std::nullopt;
}

} // namespace

core::Result<VideoEncoder> findVideoEncoder(const fs::path& named, const VideoFormat& format) {
    VideoEncoder encoder;
    encoder.format = format;
    encoder.program = named;
    if (named.empty()) {
        const auto found = findProgram("ffmpeg");
        if (!found)
            return core::makeError(
                "a film needs the program ffmpeg, which is not on PATH: install the package "
                "ffmpeg, or name the program with --ffmpeg"
            );
        encoder.program = *found;
    }
    const auto version = runProcess(encoder.program, {"-version"}, ".");
    if (!version)
        return version.error();
    const std::string_view firstLine = findFirstLine(version.value().output);
    if (version.value().exitStatus != 0 || !firstLine.starts_with("ffmpeg version"))
        return core::makeError("'{}' is no ffmpeg", encoder.program.string());
    encoder.version = firstLine;
    const auto encoders = runProcess(encoder.program, {"-hide_banner", "-encoders"}, ".");
    if (!encoders)
        return encoders.error();
    std::string names;
    for (const CodecRow& row : listCodecs()) {
        if (!isOfFormat(row, format))
            continue;
        if (encoders.value().output.find(fmt::format(" {} ", row.name)) != std::string::npos) {
            encoder.codec = row.name;
            return encoder;
        }
        names += fmt::format("{}{}", names.empty() ? "" : " or ", row.name);
    }
    return core::makeError(
        "'{}' does not encode with {}, which a film of this kind needs",
        encoder.program.string(),
        names
    );
}

core::Status checkFilmWritable(const fs::path& file) {
    const auto place = findFilmPlace(file);
    return place ? core::Status() : core::Status(place.error());
}

core::Status
encodeVideo(const VideoEncoder& encoder, const VideoFrames& frames, const fs::path& file) {
    const auto place = findFilmPlace(file);
    if (!place)
        return place.error();
    std::error_code failure;
    const fs::path target = fs::absolute(core::makeTemporaryPath(place.value()), failure);
    const auto fail = [&](std::string_view why) {
        std::error_code ignored;
        fs::remove(target, ignored);
        return core::makeError("cannot write '{}': {}", file.string(), why);
    };
    if (const auto missing = findMissingFrame(frames))
        return fail(fmt::format("the frame '{}' is missing", missing->string()));
    const auto run = runProcess(
        encoder.program, listArguments(encoder, frames, findContainer(file), target), frames.folder
    );
    if (!run)
        return fail(run.error().message);
    if (run.value().exitStatus != 0)
        return fail(fmt::format(
            "{} ended with status {}: {}",
            encoder.program.string(),
            run.value().exitStatus,
            findLastLine(run.value().errors)
        ));
    // It prints nothing on success, and nothing about missing frames either.
    if (!run.value().errors.empty())
        return fail(fmt::format(
            "{} reports: {}", encoder.program.string(), findLastLine(run.value().errors)
        ));
    if (const auto missing = findMissingFrame(frames))
        return fail(fmt::format("the frame '{}' is missing", missing->string()));
    if (fs::file_size(target, failure) == 0 || failure)
        return fail("ffmpeg wrote nothing");
    const core::Status replaced = core::replaceFile(target, place.value());
    return replaced ? replaced : fail(replaced.error().message);
}

} // namespace shutter::io
