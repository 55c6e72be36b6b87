// SPDX-License-Identifier: MIT
// Draws frames in sequence, writes each to disk before the next, and skips complete ones. The
// frames of a film (`--out FILE.mp4`) are PNG files in the folder FILE.mp4.frames. Several
// processes may each draw a part: each has its own journal, and the whole's journal merges them.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/io/video.h"
#include "game/output/render_options.h"
#include "game/shot/shot.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace shutter::game {

/// Draws every frame of `options`, or those of its part, and writes the files that they name; a
/// part makes no film. Error: among others, that frames on disk were drawn otherwise, where other
/// processes may be drawing them.
/// \param encoder encodes the film; unused without one
[[nodiscard]] core::Status renderSequence(
    RenderOptions options, const std::optional<io::VideoEncoder>& encoder, gpu::Device& device
);

/// The file of a frame. A film's files count from 0.
/// \param frame index among the shot's frame times
[[nodiscard]] std::filesystem::path fileOfFrame(const RenderOptions& options, size_t frame);

/// The frame's number, by which journals know it.
/// \param frame index among the shot's frame times
[[nodiscard]] int numberOfFrame(const RenderOptions& options, size_t frame);

/// The folder of the film's frames, next to the film, and their names, from 0.
[[nodiscard]] std::filesystem::path filmFrames(const std::filesystem::path& film);

/// Finds ffmpeg and checks that the film can be written, before hours of rendering. Error: names
/// the option, and what to install.
[[nodiscard]] core::Result<io::VideoEncoder> prepareFilm(const RenderOptions& options);

/// Makes the frames' folder.
[[nodiscard]] core::Status makeFilmFolder(const RenderOptions& options);

/// Encodes the frames, all complete.
[[nodiscard]] core::Status
encodeFilm(const io::VideoEncoder& encoder, const RenderOptions& options);

/// Removes the frames of a film that is complete, and their folder, unless they are to be
/// preserved. Removes only our files: a folder with others remains.
void removeFilmFrames(const RenderOptions& options, const std::filesystem::path& framesJournal);

} // namespace shutter::game
