// SPDX-License-Identifier: MIT
// `shutter film`'s options as a person types them.
#pragma once

#include "engine/core/result.h"
#include "game/options/render_arguments.h"
#include "game/parts/job_options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace shutter::film {

/// Parts of a film that is drawn by Slurm, unless --parts says otherwise.
inline constexpr uint32_t kSlurmParts = 16;

struct FilmArguments {
    game::RenderArguments render;
    shutter::parts::JobOptions jobs;
    std::optional<uint32_t> parts; ///< else as many as there are jobs, or kSlurmParts
    bool estimate = true;

    /// Those of `shutter render`: what the film's plan keeps of the command line.
    std::vector<const CLI::Option*> renderOptions;
};

void defineFilmOptions(CLI::App& command, FilmArguments& arguments);

/// Checks what needs no file. Error: names the option that has no meaning for a film, or whose film
/// would depend on how it is split.
[[nodiscard]] core::Status
checkFilm(const FilmArguments& arguments, const game::RenderOptions& options);

/// The typed options of `shutter render` as words that mean the same. --restart is not among them:
/// a part that is started again goes on.
[[nodiscard]] std::vector<std::string> listRenderWords(const FilmArguments& arguments);

/// Parts that the film is to be split into.
[[nodiscard]] uint32_t countParts(const FilmArguments& arguments);

} // namespace shutter::film
