// SPDX-License-Identifier: MIT
#include "game/shot/instants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shutter::game {

InstantChoice chooseInstants(const render::LongestPath& path, double maxStepPx, uint32_t most) {
    InstantChoice choice;
    // Compared as numbers: a way may be longer than any integer.
    const double wanted = std::max(
        std::ceil(path.px / maxStepPx), path.movesLight ? double{kLeastInstantsOfLight} : 1.0
    );
    choice.count = wanted < most ? static_cast<uint32_t>(wanted) : most;
    choice.stepPx = path.px / choice.count;
    if (path.px > 0.0)
        choice.reason = fmt::format(
            "the longest way is {:.1f} px, {:.2f} px from one to the next", path.px, choice.stepPx
        );
    else
        choice.reason = path.movesLight ? "only light moves" : "nothing moves";
    return choice;
}

} // namespace shutter::game
