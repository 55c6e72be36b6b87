// SPDX-License-Identifier: MIT
// A film drawn by processes on this machine.
#pragma once

#include "engine/core/result.h"
#include "game/film/film.h"

#include <cstdint>
#include <string>
#include <vector>

namespace shutter::film {

struct LocalJobs {
    uint32_t count = 1;               ///< processes at once, above 0
    std::vector<std::string> devices; ///< of each process in turn, as --device; empty: the plan's
};

/// Draws the parts, each by a process of its own, with a bar of their progress on stderr. The
/// processes end when this one does. Error: what the first part that failed said; the others that
/// run are waited for, and no more are started.
[[nodiscard]] core::Status
drawParts(const Film& film, const std::vector<uint32_t>& parts, const LocalJobs& jobs);

} // namespace shutter::film
