// SPDX-License-Identifier: MIT
#include "game/output/render_options.h"

#include "engine/core/whole_file.h"
#include "engine/io/image_file.h"
#include "game/output/timecode.h"

#include <regex>

namespace shutter::game {

namespace fs = std::filesystem;

namespace {

using core::makeError;
using core::Status;

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
    // A film's frames have a folder of their own, which is not there yet.
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

} // namespace shutter::game
