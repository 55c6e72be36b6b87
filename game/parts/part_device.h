// SPDX-License-Identifier: MIT
// Which device and driver a work is done by. The first part that starts settles it in a file of the
// working folder; other drivers draw other bits and take other times, and are refused.
#pragma once

#include "engine/core/result.h"

#include <filesystem>
#include <optional>
#include <string>

namespace shutter::parts {

struct PartDevice {
    std::string name;
    std::string driver;

    bool operator==(const PartDevice&) const = default;
};

/// Nothing where none is settled yet. Error: the file cannot be read; names it.
[[nodiscard]] core::Result<std::optional<PartDevice>> readDevice(const std::filesystem::path& file);

/// Settles the work's device unless that is done: of processes that try at once, one succeeds.
/// \param noun what the sentence calls the work, "film"
/// Error: the settled one differs, and the sentence names both; or the file cannot be written.
[[nodiscard]] core::Status
settleDevice(const std::filesystem::path& file, const PartDevice& device, const std::string& noun);

} // namespace shutter::parts
