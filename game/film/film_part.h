// SPDX-License-Identifier: MIT
// What one process does of a film: draws a part, or finishes the whole.
#pragma once

#include "engine/core/result.h"
#include "game/film/film.h"

#include <cstdint>
#include <string>

namespace shutter::film {

/// What sentences call it.
inline constexpr const char* kFilmNoun = "film";
/// The hidden commands of the processes that draw and that finish.
inline constexpr const char* kPartCommand = "film-part";
inline constexpr const char* kFinishCommand = "film-finish";

/// Draws what is missing of a part. What was drawn before a stop is kept.
/// \param part index in the plan; another is an error
/// \param device takes the place of the plan's --device; empty: the plan's
/// Error: the film is not what was planned, or its device and driver are not this machine's.
[[nodiscard]] core::Status drawPart(Film film, uint32_t part, const std::string& device);

/// Whether the film was made of these pictures, however they were split and whoever drew them.
/// False for a sequence of pictures.
[[nodiscard]] bool isFilmFinished(const Film& film);

/// Checks that every frame is complete, encodes the film, and removes the working folder. Frames
/// that stay are recorded as `shutter render` records them.
/// Error: names a part that lacks a frame, or says why the film cannot be encoded.
[[nodiscard]] core::Status finishFilm(Film film);

/// What game/parts needs to know of the film.
/// \param film outlives the answer
[[nodiscard]] parts::PartWork describeWork(const Film& film);

/// Removes the working folder of a film that is finished, its frames included unless they are to be
/// kept. A folder that holds other files stays.
/// \param film its frames are planned
void removeWork(const Film& film);

} // namespace shutter::film
