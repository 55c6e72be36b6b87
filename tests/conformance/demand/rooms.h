// SPDX-License-Identifier: MIT
// Rooms with movers before detailed backgrounds: what the methods are judged on.
#pragma once

#include "tests/conformance/demand/subject.h"

#include <array>
#include <functional>
#include <memory>

namespace shutter::demand {

struct Room {
    const char* name;
    generator::GltfWriter (*build)();
    double resolvedOverGather; ///< most that a frame of resolved may take
};

/// Vase and courtyard.
[[nodiscard]] const std::array<Room, 2>& listRooms();

/// Camera `main`, at time 0, the scene's own exposure, which ends there.
[[nodiscard]] core::Result<std::unique_ptr<Stage>>
loadRoom(const DemandOptions& options, const Room& room);

/// What `add` finds in each room. Error: the device traces no rays, or add's.
[[nodiscard]] core::Result<Findings> measureRooms(
    gpu::Device& device,
    const DemandOptions& options,
    const std::function<core::Status(Findings&, gpu::Device&, const DemandOptions&, const Room&)>&
        add
);

} // namespace shutter::demand
