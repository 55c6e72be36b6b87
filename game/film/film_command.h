// SPDX-License-Identifier: MIT
// `shutter film`: a film drawn in parts, by processes of this machine or by Slurm. The hidden
// commands `film-part` and `film-finish` are what those processes run.
#pragma once

namespace CLI {
class App;
}

namespace shutter::film {

void addFilmCommands(CLI::App& app, int& exitStatus);

} // namespace shutter::film
