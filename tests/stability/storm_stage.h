// SPDX-License-Identifier: MIT
// A stage on which things come and go by the hundred.
#pragma once

#include "game/play/loop/stage.h"

#include <cstdint>
#include <memory>

namespace shutter::stability {

/// Frames from one storm to the next.
inline constexpr uint32_t kStormFrames = 25;

/// Plays `stage`. Every kStormFrames frames that are not paused, `count` copies of its smaller
/// meshes appear before the camera, every other one moving and turning; half a storm later all are
/// despawned. Where they appear depends on the frame alone.
[[nodiscard]] std::unique_ptr<game::Stage>
makeStormStage(std::unique_ptr<game::Stage> stage, uint32_t count);

} // namespace shutter::stability
