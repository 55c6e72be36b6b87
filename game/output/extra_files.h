// SPDX-License-Identifier: MIT
// The files that are written besides the pictures: intermediates (--aov), statistics (--stats) and
// hashes of what passes wrote (--hash-passes).
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device_select.h"
#include "engine/image/image.h"
#include "engine/io/image_file.h"
#include "engine/render/renderer.h"
#include "game/output/render_options.h"
#include "modules/debug_view/debug_view.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::game {

/// "folder/name.EXT" -> "folder/name.AOV.exr".
[[nodiscard]] std::filesystem::path
intermediateFile(const std::filesystem::path& out, const std::string& aov);

using debug_view::Channel;

/// The image's channels in the order of `channels`, named.
[[nodiscard]] image::Image
selectChannels(const image::Image& image, std::span<const Channel> channels);

/// Writes an intermediate with the channels that mean something, named.
/// \param aov one of debug_view::listViews() that has channels
/// \param stamp of its frame, if that is one of a sequence
[[nodiscard]] core::Status writeIntermediate(
    const std::filesystem::path& path,
    const std::string& aov,
    const image::Image& image,
    const std::optional<io::FrameStamp>& stamp = {}
);

struct PictureStatistics {
    double seconds = 0.0;
    render::FrameStatistics frame;
};

/// --stats: schema in docs/measuring.md.
[[nodiscard]] core::Status writeStatistics(
    const std::filesystem::path& path,
    const RenderOptions& options,
    const gpu::DeviceInfo& device,
    const std::vector<PictureStatistics>& pictures
);

/// --hash-passes: device, driver, and for each image that a pass wrote `frame`, `pass`, `image` and
/// `hash`, in the order in which the passes ran.
[[nodiscard]] core::Status writePassHashes(
    const std::filesystem::path& path,
    const gpu::DeviceInfo& device,
    const std::vector<render::WrittenImage>& written
);

} // namespace shutter::game
