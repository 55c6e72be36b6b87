// SPDX-License-Identifier: MIT
#include "game/output/render_options.h"

#include "engine/io/image_file.h"
#include "game/output/timecode.h"

#include <regex>
#include <system_error>
#include <unistd.h>

namespace shutter::game {

namespace fs = std::filesystem;

namespace {

using core::makeError;
using core::Status;

Status checkJsonWritable(const char* option, const fs::path& file) {
    if (file.empty())
        return {};
    std::error_code ignored;
    const auto folder = file.has_parent_path() ? file.parent_path() : ".";
    if (fs::is_directory(file, ignored))
        return makeError("{}: cannot write '{}': it is a folder", option, file.string());
    if (!fs::is_directory(folder, ignored))
        return makeError(
            "{}: cannot write '{}': the folder '{}' does not exist",
            option,
            file.string(),
            folder.string()
        );
    // A file is renamed into place, so its folder has to allow it; a pipe or a device is written
    // to.
    const bool isOther = fs::exists(file, ignored) && !fs::is_regular_file(file, ignored);
    if (::access(isOther ? file.c_str() : folder.c_str(), W_OK) != 0)
        return makeError("{}: cannot write '{}': permission denied", option, file.string());
    return {};
}

} // namespace

core::Status checkOutputs(const RenderOptions& options) {
    SHUTTER_TRY(checkJsonWritable("--stats", options.output.stats));
    SHUTTER_TRY(checkJsonWritable("--hash-passes", options.output.hashPasses));
    if (const auto timecode = findTimecode(options, 0); !timecode)
        return timecode.error();
    // A film's frames have a folder of their own, which is not there yet.
    if (!options.output.film.empty())
        return {};
    const fs::path first = frameFile(options.output.out, options.shot.firstFrame);
    if (Status writable = io::checkWritable(first); !writable)
        return makeError("--out: {}", writable.error().message);
    return {};
}

fs::path frameFile(const fs::path& pattern, int frameNumber) {
    static const std::regex kNumber("%0?([0-9]?)d");
    const std::string text = pattern.string();
    std::smatch match;
    if (!std::regex_search(text, match, kNumber))
        return pattern;
    const int width = match[1].length() > 0 ? std::stoi(match[1]) : 0;
    return match.prefix().str() + fmt::format("{:0{}}", frameNumber, width) + match.suffix().str();
}

} // namespace shutter::game
