// SPDX-License-Identifier: MIT
// A film on its way: its working folder, its plan, and what of it is drawn. Every process that
// takes part opens it anew from the folder, which holds plan.json, device.json, a log for each
// part, the jobs where a scheduler draws, and for an encoded film its frames. Each part has a
// journal beside the frames.
#pragma once

#include "engine/core/result.h"
#include "game/film/film_plan.h"
#include "game/output/render_options.h"
#include "game/parts/part_work.h"
#include "game/shot/shot.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shutter::film {

struct Film {
    std::filesystem::path work; ///< its working folder, absolute
    FilmPlan plan;
    game::RenderOptions options; ///< of the whole film
};

/// The working folder of what `--out` names: beside it.
[[nodiscard]] std::filesystem::path findWorkFolder(const game::OutputOptions& output);

[[nodiscard]] std::filesystem::path planFile(const std::filesystem::path& work);
[[nodiscard]] std::filesystem::path partJournal(const game::OutputOptions& output, uint32_t part);

/// What arguments of `shutter render` mean; the flythrough is read. Error: names the option.
[[nodiscard]] core::Result<game::RenderOptions> interpretWords(const std::vector<std::string>& words
);

/// Reads the plan and goes to the folder that its options start from.
/// Error: there is no film, or its plan is damaged.
[[nodiscard]] core::Result<Film> openFilm(const std::filesystem::path& work);

/// Loads the shot and plans its frames. Error: the scene cannot be loaded, or it, the options or
/// this program are not those that the film was planned with.
[[nodiscard]] core::Result<game::Shot> loadPlannedShot(Film& film);

/// The fingerprint that the parts' journals carry; nothing where no part has started.
/// Error: device.json is damaged.
[[nodiscard]] core::Result<std::optional<std::string>> findDrawnFingerprint(const Film& film);

/// Frames that are drawn as the journals tell, without a look at the frames: quick.
[[nodiscard]] uint32_t countDrawnFrames(const Film& film);

/// A part that lacks a frame.
struct UnfinishedPart {
    uint32_t part = 0;
    uint32_t frame = 0; ///< index among the film's frames of the first that is missing or damaged
};

/// Reads every frame.
/// \param film its frames are planned
[[nodiscard]] core::Result<std::vector<UnfinishedPart>> listUnfinishedParts(const Film& film);

/// Removes what the parts left in the working folder and their journals.
void removeWorkFiles(const Film& film);

} // namespace shutter::film
