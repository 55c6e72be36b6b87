// SPDX-License-Identifier: MIT
// `--out FILE.mp4`: frames as PNG in the folder FILE.mp4.frames, restartable, then the film.
#pragma once

#include "engine/core/result.h"
#include "engine/io/video.h"
#include "game/output/render_options.h"

#include <filesystem>
#include <string>

namespace shutter::game {

/// The folder beside the film that its frames are drawn into, and their names, from 0.
[[nodiscard]] std::filesystem::path filmFrames(const std::filesystem::path& film);

/// Before hours of rendering: finds ffmpeg, and checks that the film can be written. Error: names
/// the option, and what to install.
[[nodiscard]] core::Result<io::VideoEncoder> prepareFilm(const RenderOptions& options);

/// Makes the frames' folder.
[[nodiscard]] core::Status makeFilmFolder(const RenderOptions& options);

/// Encodes the frames, all complete.
[[nodiscard]] core::Status
encodeFilm(const io::VideoEncoder& encoder, const RenderOptions& options);

/// Removes the frames of a film that is complete, and their folder, unless they are to be kept.
/// Only what we put there: a folder that holds more stays.
void removeFilmFrames(const RenderOptions& options, const std::filesystem::path& framesJournal);

} // namespace shutter::game
