// SPDX-License-Identifier: MIT
// Pictures to a film, by the program ffmpeg.
#pragma once

#include "engine/core/frame_rate.h"
#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace shutter::io {

enum class VideoCodec : uint8_t {
    H264,   ///< 4:2:0, in .mp4 or .mov
    Av1,    ///< 4:2:0, in .mp4 or .mov
    ProRes, ///< 422 HQ, of 10 bits, in .mov
    Vp9,    ///< 4:2:0, of 8 bits, in .webm: every browser plays it
};

/// Encoding of a film.
struct VideoFormat {
    VideoCodec codec = VideoCodec::H264;
    uint32_t bitDepth = 8; ///< bits of a channel, 8 or 10
    std::string timecode;  ///< of the first frame, "HH:MM:SS:FF"; empty: the film carries none
    /// Vp9: target of kilobits per second, at most twice as many for short films; 0: chosen by
    /// quality.
    uint32_t kilobits = 0;
};

/// An installed ffmpeg and its encoder.
struct VideoEncoder {
    std::filesystem::path program;
    std::string codec;   ///< ffmpeg's name; for H264 of 8 bits, mpeg4 where libx264 is missing
    std::string version; ///< the first line of its version message
    VideoFormat format;
};

/// \param named the program; empty: `ffmpeg` on PATH
/// Error: there is none, or it cannot encode the format.
[[nodiscard]] core::Result<VideoEncoder>
findVideoEncoder(const std::filesystem::path& named, const VideoFormat& format = {});

/// Numbered PNG files of one folder and size; width and height are even.
struct VideoFrames {
    std::filesystem::path folder;
    std::string pattern; ///< file names as printf takes them, e.g. frame_%06d.png
    uint32_t count = 0;  ///< numbered from 0, all there
    core::FrameRate framesPerSecond;
};

/// Error: encodeVideo() cannot write there; names the file and why.
[[nodiscard]] core::Status checkFilmWritable(const std::filesystem::path& file);

/// Writes an .mp4, or a .mov or .webm where the file is called so: BT.709, no metadata except the
/// time code; the same frames give the same bits with the same ffmpeg. Takes the place of the file
/// that `file` leads to when it is complete. Error: ffmpeg's last line.
[[nodiscard]] core::Status encodeVideo(
    const VideoEncoder& encoder, const VideoFrames& frames, const std::filesystem::path& file
);

} // namespace shutter::io
