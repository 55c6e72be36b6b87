// SPDX-License-Identifier: MIT
#include "engine/image/half_float.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <iterator>

namespace shutter::image {

float roundToHalf(float value) {
    return glm::unpackHalf1x16(glm::packHalf1x16(value));
}

std::vector<uint16_t> packHalf(const Image& picture) {
    std::vector<uint16_t> bits;
    bits.reserve(picture.pixels.size());
    std::transform(
        picture.pixels.begin(),
        picture.pixels.end(),
        std::back_inserter(bits),
        [](float value) { return glm::packHalf1x16(value); }
    );
    return bits;
}

} // namespace shutter::image
