// SPDX-License-Identifier: MIT
// Every picture of a session as a file, or all of them as a film.
#pragma once

#include "engine/core/result.h"
#include "engine/image/image.h"
#include "engine/io/video.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace shutter::game {

class FilmWriter {
  public:
    /// \param out NAME%04d.png, .jpg, or .mp4, whose frames are first written to a folder next to
    /// it
    /// \param ffmpeg the program, for a film; empty: the one on PATH
    /// \param fps frames per second of the film
    /// Error: ffmpeg is missing, or nothing can be written there.
    [[nodiscard]] static core::Result<std::unique_ptr<FilmWriter>> open(
        const std::filesystem::path& out, const std::filesystem::path& ffmpeg, core::FrameRate fps
    );

    /// The next picture. Error: it cannot be written, or has another size than a film's first.
    [[nodiscard]] core::Status add(const image::Image& picture);

    /// Makes the film, if it is to be one, and removes its frames.
    [[nodiscard]] core::Status finish();

  private:
    FilmWriter() = default;

    std::filesystem::path mPattern;
    std::filesystem::path mFilm; ///< empty: the frames are all
    std::optional<io::VideoEncoder> mEncoder;
    core::FrameRate mFps;
    uint32_t mCount = 0;
    uint32_t mWidth = 0;
    uint32_t mHeight = 0;
};

} // namespace shutter::game
