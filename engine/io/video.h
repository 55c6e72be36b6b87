// SPDX-License-Identifier: MIT
// Pictures to a film, by the program ffmpeg.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace shutter::io {

/// An ffmpeg that was found, and what it encodes with.
struct VideoEncoder {
    std::filesystem::path program;
    std::string codec;   ///< libx264, or mpeg4 where ffmpeg is built without it
    std::string version; ///< the first line that it says of itself
};

/// \param named the program; empty: `ffmpeg` on PATH
/// Error: there is none, or it cannot encode.
[[nodiscard]] core::Result<VideoEncoder> findVideoEncoder(const std::filesystem::path& named);

/// Numbered PNG files of one folder and size; width and height are even.
struct VideoFrames {
    std::filesystem::path folder;
    std::string pattern;           ///< file names as printf takes them, e.g. frame_%06d.png
    uint32_t count = 0;            ///< numbered from 0, all there
    double framesPerSecond = 24.0; ///< above 0
};

/// Writes an .mp4: 4:2:0, BT.709, no metadata; the same frames give the same bits with the same
/// ffmpeg. Renamed into place when it is complete. Error: ffmpeg's last line.
[[nodiscard]] core::Status encodeVideo(
    const VideoEncoder& encoder, const VideoFrames& frames, const std::filesystem::path& file
);

} // namespace shutter::io
