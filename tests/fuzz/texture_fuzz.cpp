// SPDX-License-Identifier: MIT
// Pictures inside of glTF files.
#include "engine/io/image_file.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    const auto texture = io::decodeTexture({data, size}, "images[0]");
    if (!texture) {
        fuzz::expectSentence(texture.error(), "images[0]");
        return 0;
    }
    const size_t pixels = size_t(texture.value().width) * texture.value().height;
    SHUTTER_CHECK(texture.value().rgba.size() == pixels * 4, "{} pixels", pixels);
    return 0;
}
