// SPDX-License-Identifier: MIT
// Pictures by formula, in integers alone, so that every machine makes the same: what FLIP's
// authors' tool was given for the values that flip_test.cpp expects.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::image {

/// Eight bits per channel, interleaved RGB.
struct BytePicture {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> bytes;

    template <typename Paint> // Paint(x, y, channel) -> 0 ... 255
    BytePicture(uint32_t w, uint32_t h, Paint paint) : width(w), height(h) {
        for (uint32_t y = 0; y < h; ++y)
            for (uint32_t x = 0; x < w; ++x)
                for (uint32_t c = 0; c < 3; ++c)
                    bytes.push_back(static_cast<uint8_t>(paint(x, y, c)));
    }
};

struct PicturePair {
    BytePicture reference;
    BytePicture test;
};

/// No pattern over x, y and channel.
inline uint32_t hashByte(uint32_t x, uint32_t y, uint32_t c, uint32_t seed) {
    uint32_t h = x * 73856093u ^ y * 19349663u ^ c * 83492791u ^ seed * 2654435761u;
    h = (h ^ (h >> 16)) * 0x7FEB352Du;
    h = (h ^ (h >> 15)) * 0x846CA68Bu;
    return (h ^ (h >> 16)) & 0xFFu;
}

/// The pair that a row of flip_test.cpp's table names; empty pictures for an unknown name.
inline PicturePair makePicturePair(std::string_view name) {
    const auto pair = [](uint32_t w, uint32_t h, auto reference, auto test) {
        return PicturePair{BytePicture(w, h, reference), BytePicture(w, h, test)};
    };
    const auto constant = [](uint32_t r, uint32_t g, uint32_t b) {
        return [=](uint32_t, uint32_t, uint32_t c) { return c == 0 ? r : (c == 1 ? g : b); };
    };
    const auto noise = [](uint32_t seed) {
        return [=](uint32_t x, uint32_t y, uint32_t c) { return hashByte(x, y, c, seed); };
    };
    const auto ramp = [](uint32_t x, uint32_t y, uint32_t c) {
        return c == 0 ? x * 2 : (c == 1 ? y * 3 : 255 - x - y);
    };
    const auto edge = [](uint32_t at) {
        return [=](uint32_t x, uint32_t, uint32_t c) { return x < at ? 40u + 30 * c : 220u; };
    };
    const auto lines = [](uint32_t at) {
        return [=](uint32_t x, uint32_t y, uint32_t) {
            return (x + at) % 16 == 0 || (y + 2 * at) % 24 == 0 ? 255u : 20u;
        };
    };
    if (name == "black, white")
        return pair(64, 48, constant(0, 0, 0), constant(255, 255, 255));
    if (name == "green, blue")
        return pair(40, 40, constant(0, 255, 0), constant(0, 0, 255));
    if (name == "grey, a little brighter")
        return pair(40, 40, constant(128, 128, 128), constant(131, 131, 131));
    if (name == "ramp, noisy ramp")
        return pair(96, 64, ramp, [&](uint32_t x, uint32_t y, uint32_t c) {
            return (ramp(x, y, c) * 7 + hashByte(x, y, c, 1)) / 8;
        });
    if (name == "noise, other noise")
        return pair(80, 60, noise(2), noise(3));
    if (name == "edge, edge moved")
        return pair(64, 64, edge(30), edge(33));
    if (name == "thin lines, moved")
        return pair(97, 61, lines(0), lines(5));
    if (name == "one firefly")
        return pair(33, 33, constant(30, 40, 50), [](uint32_t x, uint32_t y, uint32_t c) {
            return x == 16 && y == 16 ? 255u : 30 + 10 * c;
        });
    if (name == "noise, 17x13")
        return pair(17, 13, noise(4), noise(5));
    if (name == "1x1")
        return pair(1, 1, constant(10, 100, 200), constant(200, 100, 10));
    if (name == "equal noise")
        return pair(50, 30, noise(6), noise(6));
    if (name == "stripes, red and cyan")
        return pair(
            60,
            40,
            [](uint32_t x, uint32_t, uint32_t c) { return (x / 2) % 2 == (c == 0) ? 255u : 0u; },
            [](uint32_t x, uint32_t, uint32_t c) { return (x / 2) % 2 != (c == 0) ? 255u : 0u; }
        );
    return pair(0, 0, constant(0, 0, 0), constant(0, 0, 0));
}

} // namespace shutter::image
