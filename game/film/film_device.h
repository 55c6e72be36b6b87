// SPDX-License-Identifier: MIT
// Which device and driver draw a film. The first part that starts settles it in device.json in the
// working folder; other drivers draw other bits and are refused.
#pragma once

#include "engine/core/result.h"

#include <filesystem>
#include <optional>
#include <string>

namespace shutter::film {

struct FilmDevice {
    std::string name;
    std::string driver;

    bool operator==(const FilmDevice&) const = default;
};

/// Nothing where none is settled yet. Error: the file cannot be read; names it.
[[nodiscard]] core::Result<std::optional<FilmDevice>> readDevice(const std::filesystem::path& file);

/// Settles the film's device unless that is done: of processes that try at once, one succeeds.
/// Error: the settled one differs, and the sentence names both; or the file cannot be written.
[[nodiscard]] core::Status
settleDevice(const std::filesystem::path& file, const FilmDevice& device);

} // namespace shutter::film
