// SPDX-License-Identifier: MIT
#include "game/bench/demand/rooms.h"

#include "assets/generator/scenes.h"

namespace shutter::demand {

const std::array<Room, 2>& listRooms() {
    static constexpr std::array kRooms = {
        Room{"vase", &generator::buildVaseScene},
        Room{"courtyard", &generator::buildCourtyardScene}};
    return kRooms;
}

core::Result<std::unique_ptr<Stage>> loadRoom(const DemandOptions& options, const Room& room) {
    game::RenderArguments arguments;
    arguments.camera = "main";
    arguments.phase = "end";
    arguments.exposureSeconds = generator::kExposureSeconds;
    return loadStage(options, room.name, room.build, std::move(arguments));
}

} // namespace shutter::demand
