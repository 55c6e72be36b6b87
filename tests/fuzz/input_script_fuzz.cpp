// SPDX-License-Identifier: MIT
#include "engine/app/input_script.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    auto script = app::readInputScript(fuzz::writeInput(data, size));
    if (!script) {
        fuzz::expectSentence(script.error());
        return 0;
    }
    app::ScriptPlayer player(std::move(script).value());
    app::InputCollector input;
    constexpr int kMaxFrames = 100;
    for (int frame = 0; frame < kMaxFrames && !player.isOver(); ++frame) {
        (void)player.takeFrame(input, {640, 360});
        (void)input.take();
    }
    return 0;
}
