// SPDX-License-Identifier: MIT
#include "engine/math/blue_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace shutter::math {
namespace {

constexpr uint32_t kSide = 64;
constexpr uint32_t kSeed = 1;

using Ranks = std::vector<uint32_t>;

/// Mean power, over that of white noise, of frequencies up to `most` periods a side. The transform
/// takes the mask for periodic: a border that did not tile would show, too.
double measureLowPower(const std::vector<double>& values, int most) {
    double mean = 0.0;
    for (const double value : values)
        mean += value / double(values.size());
    double variance = 0.0;
    for (const double value : values)
        variance += (value - mean) * (value - mean);
    double power = 0.0;
    int count = 0;
    for (int v = -most; v <= most; ++v)
        for (int u = -most; u <= most; ++u) {
            if ((u == 0 && v == 0) || u * u + v * v > most * most)
                continue;
            std::complex<double> sum = 0.0;
            for (uint32_t y = 0; y < kSide; ++y)
                for (uint32_t x = 0; x < kSide; ++x)
                    sum +=
                        values[y * kSide + x] *
                        std::polar(1.0, 2.0 * std::numbers::pi * (u * int(x) + v * int(y)) / kSide);
            power += std::norm(sum);
            ++count;
        }
    return power / count / variance;
}

std::vector<double> toValues(const Ranks& ranks) {
    return {ranks.begin(), ranks.end()};
}

/// Values of `sets` parts of the ranks, after a turn by a share of all.
std::vector<double> toSets(const Ranks& ranks, double turn, int sets) {
    std::vector<double> values;
    for (const uint32_t rank : ranks) {
        const double share = rank / double(ranks.size()) + turn;
        values.push_back(std::floor((share - std::floor(share)) * sets));
    }
    return values;
}

} // namespace

TEST(BlueNoise, EachRankOccursOnce) {
    Ranks ranks = makeBlueNoise(kSide, kSeed);
    std::sort(ranks.begin(), ranks.end());
    Ranks all(kSide * kSide);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(ranks, all);
}

TEST(BlueNoise, ASeedMakesOneMask) {
    const Ranks ranks = makeBlueNoise(kSide, kSeed);
    EXPECT_EQ(ranks, makeBlueNoise(kSide, kSeed));
    EXPECT_NE(ranks, makeBlueNoise(kSide, kSeed + 1));
    // The same on every machine.
    uint64_t hash = 14695981039346656037ull;
    for (const uint32_t rank : ranks)
        hash = (hash ^ rank) * 1099511628211ull;
    EXPECT_EQ(hash, 9982874529342676899ull);
}

TEST(BlueNoise, HasHardlyAnyLowFrequencies) {
    const Ranks ranks = makeBlueNoise(kSide, kSeed);
    EXPECT_LT(measureLowPower(toValues(ranks), 8), 0.03);
    Ranks white(kSide * kSide);
    std::iota(white.begin(), white.end(), 0u);
    std::shuffle(white.begin(), white.end(), std::mt19937(3));
    EXPECT_GT(measureLowPower(toValues(white), 8), 0.7);
}

TEST(BlueNoise, SoDoFewSetsOfItHoweverItIsTurned) {
    const Ranks ranks = makeBlueNoise(kSide, kSeed);
    for (const double turn : {0.0, 0.13, 0.5, 0.618, 0.9})
        EXPECT_LT(measureLowPower(toSets(ranks, turn, 5), 8), 0.06) << turn;
}

// What crosses the border is as evenly spread as what does not: the same mask begun elsewhere.
TEST(BlueNoise, Tiles) {
    const Ranks ranks = makeBlueNoise(kSide, kSeed);
    const auto closest = [&](bool acrossBorder) {
        double sum = 0.0;
        for (uint32_t i = 0; i < kSide; ++i) {
            const uint32_t from = acrossBorder ? kSide - 1 : kSide / 2;
            const auto difference = [&](size_t a, size_t b) {
                return std::abs(double(ranks[a]) - double(ranks[b])) / (kSide * kSide);
            };
            const uint32_t to = (from + 1) % kSide;
            sum += difference(i * kSide + from, i * kSide + to);
            sum += difference(from * kSide + i, to * kSide + i);
        }
        return sum / (2.0 * kSide);
    };
    // Neighbours of white noise differ by a third.
    EXPECT_GT(closest(true), 0.4);
    EXPECT_NEAR(closest(true), closest(false), 0.06);
}

} // namespace shutter::math
