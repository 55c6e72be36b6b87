// SPDX-License-Identifier: MIT
// Work that many processes of this program do in parts, on one machine or on many: a film, a
// benchmark. It has a working folder that all of them see, with a file of the device, a log for
// each part, and the jobs where a scheduler runs them. What a part is, and when it is done, is the
// work's own affair.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::parts {

struct PartWork {
    std::string noun;             ///< what sentences call it: "film"
    std::string verb;             ///< in front of the progress bar: "rendering"
    std::string name;             ///< of its jobs in a queue
    std::filesystem::path folder; ///< working folder, absolute
    std::filesystem::path start;  ///< folder that its processes start in

    /// Hidden commands of this program: `partCommand` FOLDER PART does a part, and `finishCommand`
    /// FOLDER what comes after the last.
    std::string partCommand;
    std::string finishCommand;

    /// Steps of all parts that are done, quickly; of `stepCount`.
    std::function<uint64_t()> countDone;
    uint64_t stepCount = 0;

    /// Whether what `finishCommand` makes is there.
    std::function<bool()> isFinished;
    /// Parts that are not done, in order. Error: a file of theirs is damaged.
    std::function<core::Result<std::vector<uint32_t>>()> listUnfinished;
};

[[nodiscard]] std::filesystem::path deviceFile(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path jobsFile(const std::filesystem::path& folder);
[[nodiscard]] std::filesystem::path partLog(const std::filesystem::path& folder, uint32_t part);
/// The log of the process that finishes.
[[nodiscard]] std::filesystem::path finishLog(const std::filesystem::path& folder);

/// Removes these files, and what killed processes left of files that they were writing.
void removePartFiles(const std::filesystem::path& folder, uint32_t partCount);

/// The last line of an output that holds anything, without "shutter: " in front. Empty: none does.
[[nodiscard]] std::string findLastSentence(std::string_view output);

} // namespace shutter::parts
