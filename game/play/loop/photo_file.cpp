// SPDX-License-Identifier: MIT
#include "game/play/loop/photo_file.h"

#include "engine/core/words.h"
#include "game/play/loop/numbered_file.h"

#include <utility>

namespace shutter::game {

core::Result<std::filesystem::path> choosePhotoFile(
    const std::string& title,
    const PlaySettings& settings,
    std::span<const std::filesystem::path> taken
) {
    const std::string stem = std::filesystem::path(title).stem().string();
    return findFreeFile(".", fmt::format("{}_{}", stem, settings.method), ".png", taken);
}

std::vector<io::PictureText> describePhoto(
    const std::string& title,
    const PlaySettings& settings,
    double seconds,
    std::optional<uint32_t> rays
) {
    std::string description = fmt::format("{} at {:.3f} s, {}", title, seconds, settings.method);
    if (rays)
        description += fmt::format(", {} per pixel", core::countOf(*rays, "ray"));
    return {
        {"Software", "shutter play"},
        {"Description", std::move(description)},
        {"Settings", formatPlaySettings(settings)}};
}

} // namespace shutter::game
