// SPDX-License-Identifier: MIT
// Cache of truth pictures of `shutter bench` between runs.
#pragma once

#include "engine/core/result.h"
#include "engine/image/image.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace shutter::bench {

/// The truth of a case on disk.
struct TruthFiles {
    std::filesystem::path display; ///< PNG: what pictures are compared with
    std::filesystem::path linear;  ///< EXR of half floats: R, G, B
};

/// The files of a folder that are called so. Both are empty where the folder is.
[[nodiscard]] TruthFiles
nameTruthFiles(const std::filesystem::path& folder, const std::string& name);

struct TruthPictures {
    image::Image display; ///< 8 bits per channel, as in the file
    image::Image linear;
};

/// Returns the cached pictures; nothing if one of them is absent. One that cannot be read, or that
/// has another size or kind than the case's truth, counts as absent, with a warning: the truth is
/// drawn again and replaces it.
[[nodiscard]] std::optional<TruthPictures>
readCachedTruth(const TruthFiles& files, uint32_t width, uint32_t height);

/// Error: a file cannot be written.
[[nodiscard]] core::Status writeTruth(const TruthFiles& files, const TruthPictures& truth);

} // namespace shutter::bench
