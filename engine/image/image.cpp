// SPDX-License-Identifier: MIT
#include "engine/image/image.h"

#include "engine/core/check.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace shutter::image {

namespace {

/// Every fifteenth of the 256 colours that matplotlib publishes (CC0), 0xRRGGBB; in between it is
/// linear.
constexpr std::array<uint32_t, 18> kColors{
    0x000004,
    0x090720,
    0x1A1042,
    0x311165,
    0x4A1079,
    0x621980,
    0x792282,
    0x912B81,
    0xAA337D,
    0xC23B75,
    0xD9466B,
    0xEC5860,
    0xF7725C,
    0xFC8E64,
    0xFEAA74,
    0xFEC68A,
    0xFDE2A3,
    0xFCFDBF};

float channelOf(uint32_t color, uint32_t channel) {
    return static_cast<float>((color >> (16 - 8 * channel)) & 0xFFu) / 255.0f;
}

} // namespace

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

Image colorWithMagma(const Image& map) {
    SHUTTER_CHECK(map.channels > 0 || map.pixels.empty(), "a map without a channel");
    SHUTTER_CHECK_EQ(map.pixels.size(), size_t(map.width) * map.height * map.channels);
    Image result(map.width, map.height, 3);
    if (map.pixels.empty())
        return result;
    constexpr auto kLast = static_cast<float>(kColors.size() - 1);
    for (size_t i = 0; i < size_t(map.width) * map.height; ++i) {
        const float value = map.pixels[i * map.channels];
        // False for NaN, which is as bad as the worst.
        const float place = value < 1.0f ? std::max(value, 0.0f) * kLast : kLast;
        const size_t below = std::min(size_t(place), kColors.size() - 2);
        for (uint32_t c = 0; c < 3; ++c)
            result.pixels[i * 3 + c] = std::lerp(
                channelOf(kColors[below], c),
                channelOf(kColors[below + 1], c),
                place - static_cast<float>(below)
            );
    }
    return result;
}

} // namespace shutter::image
