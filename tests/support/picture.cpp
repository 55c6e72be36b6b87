// SPDX-License-Identifier: MIT
#include "tests/support/picture.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace shutter::test {

using image::Image;

bool allFinite(const Image& picture) {
    return std::all_of(picture.pixels.begin(), picture.pixels.end(), [](float value) {
        return std::isfinite(value);
    });
}

bool sameBits(const Image& a, const Image& b) {
    return a.width == b.width && a.height == b.height && a.channels == b.channels &&
           !a.pixels.empty() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

Image mirror(const Image& picture) {
    Image mirrored(picture.width, picture.height, picture.channels);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x)
            for (uint32_t c = 0; c < picture.channels; ++c)
                mirrored.at(picture.width - 1 - x, y, c) = picture.at(x, y, c);
    return mirrored;
}

math::dvec2 computeCentroid(const Image& picture) {
    math::dvec2 sum(0.0);
    double weight = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x)
            for (uint32_t c = 0; c < std::min(picture.channels, 3u); ++c) {
                const double value = double(picture.at(x, y, c));
                sum += value * math::dvec2(x + 0.5, y + 0.5);
                weight += value;
            }
    return sum / weight;
}

double computeMaxDifferenceWhere(
    const Image& a, const Image& b, const std::function<bool(uint32_t, uint32_t)>& where
) {
    SHUTTER_CHECK_EQ(a.width, b.width);
    SHUTTER_CHECK_EQ(a.height, b.height);
    double largest = 0.0;
    for (uint32_t y = 0; y < a.height; ++y)
        for (uint32_t x = 0; x < a.width; ++x) {
            if (!where(x, y))
                continue;
            for (uint32_t c = 0; c < 3; ++c) {
                const double difference = std::abs(double(a.at(x, y, c)) - double(b.at(x, y, c)));
                if (std::isnan(difference))
                    return std::numeric_limits<double>::infinity();
                largest = std::max(largest, difference);
            }
        }
    return largest;
}

size_t countSet(const Image& mask) {
    size_t count = 0;
    for (uint32_t y = 0; y < mask.height; ++y)
        for (uint32_t x = 0; x < mask.width; ++x)
            count += mask.at(x, y, 0) > 0.5f;
    return count;
}

} // namespace shutter::test
