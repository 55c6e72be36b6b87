// SPDX-License-Identifier: MIT
// What is measured: every method with its default settings, and the paper's with the publication's.
#pragma once

#include "engine/core/result.h"
#include "game/bench/suites/suite.h"
#include "game/shot/shot_options.h"

#include <span>
#include <string_view>

namespace shutter::bench {

/// "sharp", "gather", "gather_paper", ... in the order of game::listMethods().
[[nodiscard]] std::span<const game::MethodInfo> listContenders();

/// Error: lists the names of all contenders.
[[nodiscard]] core::Result<const game::MethodInfo*> findContender(std::string_view name);

/// \param point of a contender
[[nodiscard]] game::MethodOptions makeMethodOptions(const SamplePoint& point);

} // namespace shutter::bench
