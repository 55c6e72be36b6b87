// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/rooms.h"

#include "assets/generator/scenes.h"

namespace shutter::demand {

const std::array<Room, 2>& listRooms() {
    static constexpr std::array kRooms = {
        Room{"vase", &generator::buildVaseScene, 1.25},
        Room{"courtyard", &generator::buildCourtyardScene, 1.8}};
    return kRooms;
}

core::Result<std::unique_ptr<Stage>> loadRoom(const DemandOptions& options, const Room& room) {
    game::ShotArguments arguments;
    arguments.camera = "main";
    arguments.shutter = game::makeShutterArguments(generator::kExposureSeconds, "end");
    return loadStage(options, room.name, room.build, std::move(arguments));
}

core::Result<Findings> measureRooms(
    gpu::Device& device,
    const DemandOptions& options,
    const std::function<core::Status(Findings&, gpu::Device&, const DemandOptions&, const Room&)>&
        add
) {
    if (!device.hasRays())
        return core::makeError("{} traces no rays", device.info().name);
    Findings findings;
    for (const Room& room : listRooms())
        SHUTTER_TRY(add(findings, device, options, room));
    return findings;
}

} // namespace shutter::demand
