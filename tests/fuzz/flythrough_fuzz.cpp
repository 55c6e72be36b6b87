// SPDX-License-Identifier: MIT
#include "engine/flythrough/flythrough.h"
#include "engine/scene/motion.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    const auto read = flythrough::parseFlythrough(fuzz::asText(data, size), "fuzz_input");
    if (!read) {
        fuzz::expectSentence(read.error());
        return 0;
    }
    const flythrough::Flythrough& flight = read.value();
    const core::Status valid = flythrough::validateFlythrough(flight);
    SHUTTER_CHECK(valid.ok(), "{}", valid ? "" : valid.error().message);
    scene::World world;
    (void)flythrough::addFlythroughCamera(world, flight);
    for (const double seconds : {-1e6, 0.0, 0.3, 1e6}) {
        scene::CameraShutter shutter;
        flythrough::applyShutter(flight, seconds, shutter);
        (void)scene::worldFromEntity(world, world.cameras.at(0), seconds);
    }
    return 0;
}
