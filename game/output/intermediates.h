// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/image/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace shutter::game {

/// "folder/name.EXT" -> "folder/name.AOV.exr".
[[nodiscard]] std::filesystem::path
intermediateFile(const std::filesystem::path& out, const std::string& aov);

struct Channel {
    uint32_t source;  ///< of the image
    const char* name; ///< in the result
};

/// The image's channels in the order of `channels`, named.
[[nodiscard]] image::Image
selectChannels(const image::Image& image, const std::vector<Channel>& channels);

/// Writes an intermediate with the channels that mean something, named.
[[nodiscard]] core::Status writeIntermediate(
    const std::filesystem::path& path, const std::string& aov, const image::Image& image
);

} // namespace shutter::game
