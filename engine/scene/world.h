// SPDX-License-Identifier: MIT
#pragma once

#include "engine/ecs/registry.h"
#include "engine/scene/assets.h"
#include "engine/scene/components.h"

#include <limits>
#include <vector>

namespace shutter::scene {

/// How time runs for the animation clips.
struct Playback {
    bool loop = false;             ///< false: clips hold at their ends
    std::vector<bool> activeClips; ///< by clip; false: does not play; clips past its end play
};

/// The entities and what they refer to. Systems and extraction take it by reference; rendering
/// never sees it.
struct World {
    ecs::Registry registry;
    Assets assets;
    Playback playback;
    std::vector<ecs::Entity> cameras; ///< in the order of the file
    /// When the world came to be: nothing has a past before it. Default: it was always there.
    double startSeconds = -std::numeric_limits<double>::infinity();
};

} // namespace shutter::scene
