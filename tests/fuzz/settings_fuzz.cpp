// SPDX-License-Identifier: MIT
#include "game/play/panel/play_settings.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    const auto settings = game::loadPlaySettings(fuzz::writeInput(data, size));
    if (!settings) {
        fuzz::expectSentence(settings.error());
        return 0;
    }
    const core::Status valid = game::validate(settings.value());
    SHUTTER_CHECK(valid.ok(), "{}", valid ? "" : valid.error().message);
    return 0;
}
