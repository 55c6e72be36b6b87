// SPDX-License-Identifier: MIT
// Statistics, and noise whose values are spread evenly.
#include "engine/math/sampling.h"
#include "engine/math/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace shutter::math {
namespace {

TEST(Fit, APowerLawIsFoundExactly) {
    std::vector<CurvePoint> points;
    for (double x : {300.0, 1.0, 10.0, 1e6})
        points.push_back({x, 3.0 * std::pow(x, 0.7)});
    const auto fit = fitPower(points);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->exponent, 0.7, 1e-12);
    EXPECT_NEAR(fit->r2, 1.0, 1e-12);
    EXPECT_EQ(fit->from, 1.0);
    EXPECT_EQ(fit->to, 1e6);
}

TEST(Fit, NonFinitePointsAndPointsWithoutLogarithmOrSpreadHaveNoFit) {
    using Points = std::vector<CurvePoint>;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const Points& points :
         {Points{},
          Points{{2.0, 3.0}},
          Points{{2.0, 3.0}, {2.0, 5.0}},
          Points{{1.0, nan}, {2.0, 4.0}}}) {
        EXPECT_FALSE(fitPower(points));
        EXPECT_FALSE(fitLine(points));
    }
    EXPECT_FALSE(fitPower(Points{{0.0, 1.0}, {1.0, 2.0}, {2.0, 4.0}}));
    EXPECT_FALSE(fitPower(Points{{1.0, 0.0}, {2.0, 4.0}}));
    EXPECT_FALSE(fitLine(Points{{nan, 1.0}, {2.0, 4.0}}));
    EXPECT_FALSE(fitLine(Points{{1.0, infinity}, {2.0, 4.0}}));
}

TEST(LineFit, ALineIsFoundExactlyAndScatterLowersTheShareExplained) {
    std::vector<CurvePoint> points;
    for (double x : {5.0, 0.0, 1.0, -2.0})
        points.push_back({x, 0.25 + 3.0 * x});
    const auto fit = fitLine(points);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, 3.0, 1e-12);
    EXPECT_NEAR(fit->intercept, 0.25, 1e-12);
    EXPECT_NEAR(fit->r2, 1.0, 1e-12);
    // By hand: xx = 5, xy = 5, yy = 10.
    const auto scattered = fitLine(std::vector<CurvePoint>{{0, 0}, {1, 3}, {2, 1}, {3, 4}});
    ASSERT_TRUE(scattered);
    EXPECT_NEAR(scattered->slope, 1.0, 1e-12);
    EXPECT_NEAR(scattered->intercept, 0.5, 1e-12);
    EXPECT_NEAR(scattered->r2, 0.5, 1e-12);
    const auto flat = fitLine(std::vector<CurvePoint>{{0.0, 3.0}, {2.0, 3.0}});
    ASSERT_TRUE(flat);
    EXPECT_EQ(flat->slope, 0.0);
    EXPECT_EQ(flat->intercept, 3.0);
    EXPECT_EQ(flat->r2, 1.0) << "a constant is explained";
}

TEST(Quartiles, QuartilesAreThoseOfNumpyInAnyOrder) {
    // numpy.percentile([1, 2, 4, 8, 16, 32], [25, 50, 75])
    const Quartiles six = computeQuartiles({32.0, 1.0, 16.0, 2.0, 8.0, 4.0});
    EXPECT_DOUBLE_EQ(six.q1, 2.5);
    EXPECT_DOUBLE_EQ(six.median, 6.0);
    EXPECT_DOUBLE_EQ(six.q3, 14.0);
    const Quartiles one = computeQuartiles({4.0});
    EXPECT_EQ(one.q1, 4.0);
    EXPECT_EQ(one.median, 4.0);
    EXPECT_EQ(one.q3, 4.0);
}

constexpr uint32_t kSide = 64;
constexpr uint32_t kSeed = 1;

using Ranks = std::vector<uint32_t>;

const Ranks& getRanks() {
    static const Ranks kRanks = makeBlueNoise(kSide, kSeed);
    return kRanks;
}

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

TEST(BlueNoise, ASeedMakesOneMaskInWhichEachRankOccursOnce) {
    const Ranks& ranks = getRanks();
    EXPECT_EQ(ranks, makeBlueNoise(kSide, kSeed));
    EXPECT_NE(ranks, makeBlueNoise(kSide, kSeed + 1));
    // The same on every machine.
    uint64_t hash = 14695981039346656037ull;
    for (const uint32_t rank : ranks)
        hash = (hash ^ rank) * 1099511628211ull;
    EXPECT_EQ(hash, 9982874529342676899ull);
    EXPECT_EQ(std::set(ranks.begin(), ranks.end()).size(), size_t(kSide) * kSide);
    EXPECT_EQ(*std::max_element(ranks.begin(), ranks.end()), kSide * kSide - 1);
}

TEST(BlueNoise, MasksAndTheirSmallSetsInAnyRotationHaveFewLowFrequencies) {
    const Ranks& ranks = getRanks();
    EXPECT_LT(measureLowPower(toValues(ranks), 8), 0.03);
    Ranks white(kSide * kSide);
    std::iota(white.begin(), white.end(), 0u);
    std::shuffle(white.begin(), white.end(), std::mt19937(3));
    EXPECT_GT(measureLowPower(toValues(white), 8), 0.7);
    for (const double turn : {0.0, 0.13, 0.5, 0.618, 0.9})
        EXPECT_LT(measureLowPower(toSets(ranks, turn, 5), 8), 0.06) << turn;
}

// Points across the border are as evenly spread as others: the same mask with another origin.
TEST(BlueNoise, MasksTile) {
    const Ranks& ranks = getRanks();
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

} // namespace
} // namespace shutter::math
