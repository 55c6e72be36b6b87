// SPDX-License-Identifier: MIT
#include "engine/math/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace shutter::math {

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

TEST(Fit, ScatterLowersTheShareExplained) {
    std::vector<CurvePoint> points;
    const double logarithms[] = {0.0, 3.0, 1.0, 4.0};
    for (int i = 0; i < 4; ++i)
        points.push_back({std::exp(i), std::exp(logarithms[i])});
    // By hand: xx = 5, xy = 5, yy = 10.
    const auto fit = fitPower(points);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->exponent, 1.0, 1e-12);
    EXPECT_NEAR(fit->r2, 0.5, 1e-12);
}

TEST(Fit, AConstantIsExplained) {
    const std::vector<CurvePoint> flat{{1.0, 3.0}, {2.0, 3.0}};
    const auto fit = fitPower(flat);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->exponent, 0.0);
    EXPECT_EQ(fit->r2, 1.0);
}

TEST(Fit, WhatHasNoLogarithmOrNoSpreadHasNoFit) {
    using Points = std::vector<CurvePoint>;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Points& points :
         {Points{},
          Points{{2.0, 3.0}},
          Points{{2.0, 3.0}, {2.0, 5.0}},
          Points{{0.0, 1.0}, {1.0, 2.0}, {2.0, 4.0}},
          Points{{1.0, 0.0}, {2.0, 4.0}},
          Points{{1.0, nan}, {2.0, 4.0}}})
        EXPECT_FALSE(fitPower(points));
}

TEST(LineFit, ALineIsFoundExactly) {
    std::vector<CurvePoint> points;
    for (double x : {5.0, 0.0, 1.0, -2.0})
        points.push_back({x, 0.25 + 3.0 * x});
    const auto fit = fitLine(points);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, 3.0, 1e-12);
    EXPECT_NEAR(fit->intercept, 0.25, 1e-12);
    EXPECT_NEAR(fit->r2, 1.0, 1e-12);
}

TEST(LineFit, ScatterLowersTheShareExplained) {
    // By hand: xx = 5, xy = 5, yy = 10.
    const std::vector<CurvePoint> points{{0, 0}, {1, 3}, {2, 1}, {3, 4}};
    const auto fit = fitLine(points);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, 1.0, 1e-12);
    EXPECT_NEAR(fit->intercept, 0.5, 1e-12);
    EXPECT_NEAR(fit->r2, 0.5, 1e-12);
}

TEST(LineFit, AConstantIsExplained) {
    const std::vector<CurvePoint> flat{{0.0, 3.0}, {2.0, 3.0}};
    const auto fit = fitLine(flat);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->slope, 0.0);
    EXPECT_EQ(fit->intercept, 3.0);
    EXPECT_EQ(fit->r2, 1.0);
}

TEST(LineFit, WhatIsNotFiniteOrHasNoSpreadHasNoFit) {
    using Points = std::vector<CurvePoint>;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const Points& points :
         {Points{},
          Points{{2.0, 3.0}},
          Points{{2.0, 3.0}, {2.0, 5.0}},
          Points{{nan, 1.0}, {2.0, 4.0}},
          Points{{1.0, infinity}, {2.0, 4.0}}})
        EXPECT_FALSE(fitLine(points));
}

TEST(Quartiles, OneValueIsAllThree) {
    const Quartiles one = computeQuartiles({4.0});
    EXPECT_EQ(one.median, 4.0);
    EXPECT_EQ(one.q1, 4.0);
    EXPECT_EQ(one.q3, 4.0);
}

TEST(Quartiles, AreThoseOfNumpyWhateverTheOrder) {
    // numpy.percentile([1, 2, 4, 8, 16, 32], [25, 50, 75])
    const Quartiles six = computeQuartiles({32.0, 1.0, 16.0, 2.0, 8.0, 4.0});
    EXPECT_DOUBLE_EQ(six.q1, 2.5);
    EXPECT_DOUBLE_EQ(six.median, 6.0);
    EXPECT_DOUBLE_EQ(six.q3, 14.0);
}

} // namespace shutter::math
