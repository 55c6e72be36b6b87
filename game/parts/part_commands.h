// SPDX-License-Identifier: MIT
// The commands that the processes of a work run, and what its plan keeps of the command line.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace shutter::parts {

struct PartArguments {
    std::filesystem::path folder; ///< the work's
    uint32_t part = 0;            ///< index in the plan
    std::string device;           ///< in place of the work's own; empty: its own
};

/// Commands that `--help` does not list: NAME FOLDER PART [--device], and NAME FOLDER.
struct PartCommands {
    const char* noun;   ///< what their help calls the work: "film"
    const char* part;   ///< name of the command that does a part
    const char* finish; ///< name of the one that comes after the last
    core::Status (*doPart)(const PartArguments&);
    core::Status (*doFinish)(const PartArguments&);
};

/// \param exitStatus what they leave (game/options/program.h)
void addPartCommands(CLI::App& app, int& exitStatus, const PartCommands& commands);

/// Error: the work has no part of that index.
/// \param noun what the sentence calls the work
[[nodiscard]] core::Status checkPart(uint32_t part, size_t partCount, const std::string& noun);

/// What was typed of `options` as words that mean the same, without those of the names in `left`.
[[nodiscard]] std::vector<std::string>
listTypedWords(std::span<const CLI::Option* const> options, std::span<const std::string_view> left);

/// Sets the options of `command` by words. Error: what is wrong with them.
[[nodiscard]] core::Status parseWords(CLI::App& command, std::span<const std::string> words);

} // namespace shutter::parts
