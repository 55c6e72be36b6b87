// SPDX-License-Identifier: MIT
// Rooms with movers before detailed backgrounds: what the methods are judged on.
#pragma once

#include "game/bench/demand/subject.h"

#include <array>
#include <memory>

namespace shutter::demand {

struct Room {
    const char* name;
    generator::GltfWriter (*build)();
};

/// Vase and courtyard.
[[nodiscard]] const std::array<Room, 2>& listRooms();

/// Camera `main`, at time 0, the scene's own exposure, which ends there.
[[nodiscard]] core::Result<std::unique_ptr<Stage>>
loadRoom(const DemandOptions& options, const Room& room);

} // namespace shutter::demand
