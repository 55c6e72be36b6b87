// SPDX-License-Identifier: MIT
// The file of a saved picture: its name, and what it says of how the picture was made.
#pragma once

#include "engine/core/result.h"
#include "engine/io/image_file.h"
#include "game/play/panel/play_settings.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::game {

/// A file of the current folder that is not there yet: "rally_truth_001.png".
/// \param title of the stage, a demo's name or a file's
/// \param taken files that will be there soon
[[nodiscard]] core::Result<std::filesystem::path> choosePhotoFile(
    const std::string& title,
    const PlaySettings& settings,
    std::span<const std::filesystem::path> taken
);

/// \param seconds of the picture \param rays per pixel so far, where it is traced
[[nodiscard]] std::vector<io::PictureText> describePhoto(
    const std::string& title,
    const PlaySettings& settings,
    double seconds,
    std::optional<uint32_t> rays
);

} // namespace shutter::game
