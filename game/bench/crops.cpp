// SPDX-License-Identifier: MIT
#include "game/bench/crops.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>

namespace shutter::bench {

namespace {

bool meets(const Crop& a, const Crop& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
           b.y < a.y + a.height;
}

double sumDifference(const image::Image& a, const image::Image& b, const Crop& crop) {
    const uint32_t channels = std::min({a.channels, b.channels, 3u});
    double sum = 0.0;
    for (uint32_t y = crop.y; y < crop.y + crop.height; ++y)
        for (uint32_t x = crop.x; x < crop.x + crop.width; ++x)
            for (uint32_t c = 0; c < channels; ++c) {
                const double difference = std::abs(a.at(x, y, c) - b.at(x, y, c));
                sum += std::isfinite(difference) ? difference : 1.0;
            }
    return sum;
}

} // namespace

std::vector<Crop> findLargestDifference(
    const image::Image& a,
    const image::Image& b,
    uint32_t sidePx,
    const std::string& label,
    const std::vector<Crop>& taken
) {
    SHUTTER_CHECK(a.width == b.width && a.height == b.height, "pictures of two sizes");
    SHUTTER_CHECK(sidePx >= 4, "{}", sidePx);
    std::vector<Crop> best;
    double largest = 0.0;
    for (uint32_t y = 0; y + sidePx <= a.height; y += sidePx / 4)
        for (uint32_t x = 0; x + sidePx <= a.width; x += sidePx / 4) {
            const Crop crop{x, y, sidePx, sidePx, label};
            const bool blocked = std::any_of(taken.begin(), taken.end(), [&](const Crop& other) {
                return meets(crop, other);
            });
            const double sum = blocked ? 0.0 : sumDifference(a, b, crop);
            if (sum <= largest)
                continue;
            largest = sum;
            best = {crop};
        }
    return best;
}

} // namespace shutter::bench
