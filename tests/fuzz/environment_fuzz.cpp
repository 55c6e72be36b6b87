// SPDX-License-Identifier: MIT
// Pictures that light a scene.
#include "engine/environment/environment.h"
#include "engine/io/image_file.h"
#include "tests/fuzz/fuzz_file.h"

#include <vector>

namespace {

using namespace shutter;

/// Neither infinity nor NaN, all of whose exponent's bits are set.
void checkHalves(const std::vector<scene::DirectionPicture>& levels) {
    SHUTTER_CHECK(!levels.empty(), "no level");
    for (const scene::DirectionPicture& level : levels) {
        const size_t texels = size_t(level.width) * level.height;
        SHUTTER_CHECK(level.rgba.size() == texels * 4, "{} values", level.rgba.size());
        for (const uint16_t half : level.rgba)
            SHUTTER_CHECK((half & 0x7c00u) != 0x7c00u, "{:#x} is not finite", half);
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    auto read = io::readImage(fuzz::writeInput(data, size));
    if (!read) {
        fuzz::expectSentence(read.error());
        return 0;
    }
    // Wider ones take longer, by the same code.
    constexpr uint32_t kMaxFuzzed = 16;
    if (read.value().width > kMaxFuzzed)
        return 0;
    for (const double intensity : {0.0, 1000.0}) {
        const auto made = environment::makeEnvironment(read.value(), {.intensity = intensity});
        if (!made) {
            fuzz::expectSentence(made.error(), "environment");
            return 0;
        }
        checkHalves(made.value().background);
        checkHalves(made.value().mirrored);
    }
    return 0;
}
