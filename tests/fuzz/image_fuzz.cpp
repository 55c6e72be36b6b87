// SPDX-License-Identifier: MIT
// Pictures that are compared, and those that `bench` keeps as truth.
#include "engine/io/image_file.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    const auto read = io::readImage(fuzz::writeInput(data, size));
    if (!read) {
        fuzz::expectSentence(read.error());
        return 0;
    }
    const image::Image& image = read.value();
    SHUTTER_CHECK(
        image.pixels.size() == size_t(image.width) * image.height * image.channels,
        "{} values",
        image.pixels.size()
    );
    return 0;
}
