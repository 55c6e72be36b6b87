// SPDX-License-Identifier: MIT
#include "game/output/render_options.h"

#include "engine/core/whole_file.h"
#include "engine/core/words.h"
#include "engine/io/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <regex>

namespace shutter::game {

namespace fs = std::filesystem;

namespace {

using core::makeError;
using core::Status;

constexpr int64_t kSecondsADay = 24 * 3600;

/// Two digits of "HH:MM:SS:FF".
int64_t readPair(const std::string& text, size_t place) {
    return std::stol(text.substr(3 * place, 2));
}

/// Frames since 00:00:00:00 of the first frame. Error: names --timecode.
core::Result<int64_t> countFrames(const RenderOptions& options, int64_t rate) {
    const std::string& text = options.output.video.timecode;
    if (text == kTimecodeOfFrame) {
        const int64_t first = options.shot.firstFrame;
        if (first < 0 || first >= kSecondsADay * rate)
            return core::makeError("--timecode frame: frame {} has none", first);
        return first;
    }
    if (readPair(text, 0) >= 24)
        return core::makeError("--timecode {}: a day has 24 hours, numbered from 0", text);
    if (readPair(text, 3) >= rate)
        return core::makeError(
            "--timecode {}: a second has {}, numbered from 0",
            text,
            core::countOf(uint64_t(rate), "frame")
        );
    return ((readPair(text, 0) * 60 + readPair(text, 1)) * 60 + readPair(text, 2)) * rate +
           readPair(text, 3);
}

Status checkJsonWritable(const char* option, const fs::path& file) {
    if (file.empty())
        return {};
    const Status able = core::checkOutput(file);
    return able ? able
                : makeError(
                      "{}: cannot write '{}': {}", option, file.string(), able.error().message
                  );
}

} // namespace

core::Status checkOutputs(const RenderOptions& options) {
    SHUTTER_TRY(checkJsonWritable("--stats", options.output.stats));
    SHUTTER_TRY(checkJsonWritable("--hash-passes", options.output.hashPasses));
    if (const auto timecode = findTimecode(options, 0); !timecode)
        return timecode.error();
    // A film's frames have a separate folder, which does not exist yet.
    if (!options.output.film.empty())
        return {};
    const fs::path first = frameFile(options.output.out, options.shot.firstFrame);
    if (Status writable = io::checkWritable(first); !writable)
        return makeError("--out: {}", writable.error().message);
    return {};
}

fs::path frameFile(const fs::path& pattern, int frameNumber) {
    static const std::regex kSpecial("%(?:%|0?([0-9]{0,2})d)");
    const std::string name = pattern.filename().string();
    std::string made;
    auto rest = name.cbegin();
    for (std::sregex_iterator found(name.begin(), name.end(), kSpecial), end; found != end;
         ++found) {
        const std::smatch& match = *found;
        made.append(rest, match[0].first);
        if (match.str() == "%%")
            made += '%';
        else
            made += fmt::format(
                "{:0{}}", frameNumber, match.length(1) > 0 ? std::stoi(match.str(1)) : 0
            );
        rest = match[0].second;
    }
    made.append(rest, name.cend());
    return made == name ? pattern : fs::path(pattern).replace_filename(made);
}

core::Result<std::optional<io::Timecode>> findTimecode(const RenderOptions& options, size_t frame) {
    if (options.output.video.timecode.empty())
        return std::optional<io::Timecode>();
    const int64_t rate = std::max<int64_t>(1, std::llround(options.shot.fps.perSecond()));
    if (options.output.film.empty() && rate > io::kMaxTimecodeRate)
        return core::makeError(
            "--timecode: an EXR's counts {} frames a second at most, and --fps is {}",
            io::kMaxTimecodeRate,
            core::describe(options.shot.fps)
        );
    const auto first = countFrames(options, rate);
    if (!first)
        return first.error();
    const int64_t count = (first.value() + int64_t(frame)) % (kSecondsADay * rate);
    const int64_t second = count / rate;
    return std::optional(io::Timecode{
        uint32_t(second / 3600),
        uint32_t(second / 60 % 60),
        uint32_t(second % 60),
        uint32_t(count % rate)});
}

core::Result<std::optional<io::FrameStamp>> findStamp(const RenderOptions& options, size_t frame) {
    const auto timecode = findTimecode(options, frame);
    if (!timecode)
        return timecode.error();
    if (!options.shot.isSequence)
        return std::optional<io::FrameStamp>();
    return std::optional(io::FrameStamp{options.shot.fps, timecode.value()});
}

std::string describe(const io::Timecode& timecode) {
    return fmt::format(
        "{:02}:{:02}:{:02}:{:02}",
        timecode.hours,
        timecode.minutes,
        timecode.seconds,
        timecode.frames
    );
}

} // namespace shutter::game
