// SPDX-License-Identifier: MIT
// Frames one after the other, each on disk before the next, those that are there already left out;
// and the film of `--out FILE.mp4`, whose frames are PNG files in the folder FILE.mp4.frames.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/io/video.h"
#include "game/output/render_options.h"

#include <filesystem>
#include <optional>
#include <string>

namespace shutter::game {

/// Draws every frame of `options`, which may become a film, and writes what was asked for.
/// \param encoder of the film, where there is to be one
[[nodiscard]] core::Status renderSequence(
    RenderOptions options, const std::optional<io::VideoEncoder>& encoder, gpu::Device& device
);

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
