// SPDX-License-Identifier: MIT
#include "game/replay/dump_reader.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    const auto file = fuzz::writeInput(data, size);
    auto frame = replay::readDumpManifest(file);
    if (!frame) {
        fuzz::expectSentence(frame.error());
        return 0;
    }
    for (const auto& [name, image] : frame.value().images)
        SHUTTER_CHECK(image.file.find('/') == std::string::npos, "'{}' leaves the folder", name);
    // None of the files that it names exist.
    SHUTTER_CHECK(
        !replay::readDumpTexels("/nonexistent", frame.value()).ok(), "texels were read of nowhere"
    );
    return 0;
}
