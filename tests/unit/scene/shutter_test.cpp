// SPDX-License-Identifier: MIT
#include "engine/scene/shutter.h"
#include "shaders/common/shutter_response.glsl"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace shutter::scene {
namespace {

CameraShutter makeShutter(ShutterMode mode) {
    CameraShutter shutter;
    shutter.mode = mode;
    shutter.exposureSeconds = 0.01;
    shutter.angleDegrees = 180.0;
    shutter.referenceFps = 24.0;
    return shutter;
}

ShutterResponse trapezoid(double open, double close) {
    ShutterResponse response;
    response.shape = ResponseShape::Trapezoid;
    response.openShare = open;
    response.closeShare = close;
    return response;
}

ShutterResponse sampled(std::vector<double> samples) {
    ShutterResponse response;
    response.shape = ResponseShape::Sampled;
    response.samples = std::move(samples);
    return response;
}

/// As many samples as a table has knots, none of them alike its neighbours.
ShutterResponse sampledMost(size_t factor = 7, size_t modulus = 5) {
    std::vector<double> most(shader::kMaxResponseKnots);
    for (size_t i = 0; i < most.size(); ++i)
        most[i] = double((i * factor) % modulus);
    return sampled(most);
}

ShutterResponse triangle() {
    ShutterResponse response;
    response.shape = ResponseShape::Triangle;
    return response;
}

/// The light before s over all light, by adding up thin slices of the response's own definition.
double integrate(const std::function<double(double)>& height, double s) {
    constexpr int kSlices = 200000;
    double before = 0.0;
    double all = 0.0;
    for (int i = 0; i < kSlices; ++i) {
        const double at = (i + 0.5) / kSlices;
        all += height(at);
        before += at < s ? height(at) : 0.0;
    }
    return before / all;
}

TEST(ExposureSeconds, PhysicalIsTheSameAtEveryFrameRateAnglesAreSharesOfFramesAndCapsHold) {
    struct Case {
        ShutterMode mode;
        double degrees;
        double frame;
        double expected;
    };

    const Case cases[] = {
        {ShutterMode::Physical, 180.0, 1.0 / 240.0, 0.01},
        {ShutterMode::Physical, 180.0, 1.0 / 24.0, 0.01},
        {ShutterMode::Physical, 180.0, 10.0, 0.01},
        {ShutterMode::Angle, 180.0, 1.0 / 24.0, 1.0 / 48.0},
        {ShutterMode::Angle, 180.0, 1.0 / 120.0, 1.0 / 240.0},
        {ShutterMode::Angle, 180.0, 10.0, 5.0}, // a hitch smears
        {ShutterMode::Angle, 720.0, 0.1, 0.2},  // longer than a frame
        {ShutterMode::Angle, 180.0, kInfinity, 0.0},
        {ShutterMode::Capped, 180.0, 10.0, 1.0 / 48.0},
        {ShutterMode::Capped, 180.0, kInfinity, 1.0 / 48.0},
        {ShutterMode::Capped, 180.0, 1.0 / 12.0, 1.0 / 48.0},
        {ShutterMode::Capped, 180.0, 1.0 / 60.0, 1.0 / 120.0}};
    for (const Case& each : cases) {
        CameraShutter shutter = makeShutter(each.mode);
        shutter.angleDegrees = each.degrees;
        EXPECT_DOUBLE_EQ(computeExposureSeconds(shutter, each.frame), each.expected)
            << int(each.mode) << " " << each.frame;
    }
}

TEST(ExposureSeconds, ExposureIsZeroWhenPausedOrOfADurationThatIsNone) {
    for (const double bad : {kNan, -1.0, 0.0}) {
        CameraShutter shutter;
        shutter.exposureSeconds = bad;
        shutter.angleDegrees = bad;
        for (const ShutterMode mode :
             {ShutterMode::Physical, ShutterMode::Angle, ShutterMode::Capped}) {
            EXPECT_EQ(computeExposureSeconds(makeShutter(mode), bad), 0.0);
            shutter.mode = mode;
            EXPECT_EQ(computeExposureSeconds(shutter, 0.1), 0.0) << int(mode) << " " << bad;
        }
        shutter = makeShutter(ShutterMode::Capped);
        shutter.referenceFps = bad;
        EXPECT_EQ(computeExposureSeconds(shutter, 0.1), 0.0) << bad;
    }
    CameraShutter endless = makeShutter(ShutterMode::Physical);
    endless.exposureSeconds = kInfinity;
    EXPECT_EQ(computeExposureSeconds(endless, 0.1), 0.0);
    endless = makeShutter(ShutterMode::Angle);
    endless.angleDegrees = kInfinity;
    EXPECT_EQ(computeExposureSeconds(endless, 0.1), 0.0);
}

TEST(ComputeExposure, TheExposureContainsItsFrameAndShutter) {
    CameraShutter shutter = makeShutter(ShutterMode::Angle);
    shutter.phase = ShutterPhase::Centre;
    shutter.objectScale = 0.5;
    const ExposureInterval interval = computeExposure(shutter, 2.0, 0.1);
    EXPECT_DOUBLE_EQ(interval.open, 1.975);
    EXPECT_DOUBLE_EQ(interval.close, 2.025);
    EXPECT_EQ(interval.frameSeconds, 0.1);
    EXPECT_EQ(interval.shutter.objectScale, 0.5);
    EXPECT_EQ(computeExposure(shutter, 2.0, kNan).frameSeconds, 0.0);
}

TEST(Response, AConstantResponseNeedsNoTableAndTheTrianglesInverseIsTheClosedForm) {
    EXPECT_FALSE(computeResponseTable({}));
    EXPECT_FALSE(computeResponseTable(trapezoid(0.0, 0.0)));
    EXPECT_FALSE(computeResponseTable(trapezoid(1e-9, 1e-9))) << "no flank in single precision";
    EXPECT_FALSE(computeResponseTable(sampled({3.0, 3.0, 3.0})));
    for (const double u : {0.0, 0.1, 0.7, 1.0})
        EXPECT_EQ(invertResponse({}, u), u);
    for (double u = 0.0; u <= 1.0; u += 1.0 / 64.0) {
        const double expected = u < 0.5 ? std::sqrt(u / 2.0) : 1.0 - std::sqrt((1.0 - u) / 2.0);
        // Near the end 1 - u is known to 2^-24, its root to 2^-12.
        EXPECT_NEAR(invertResponse(triangle(), u), expected, u > 0.99 ? 3e-4 : 1e-6) << u;
    }
    EXPECT_EQ(invertResponse(triangle(), 0.0), 0.0);
    EXPECT_NEAR(invertResponse(triangle(), 0.5), 0.5, 1e-7);
}

TEST(Response, TheInverseGoesBackToTheLightOfTheDefinition) {
    struct Case {
        ShutterResponse response;
        std::function<double(double)> height;
    };

    const auto samples = std::vector<double>{0.0, 5.0, 5.0, 0.0, 0.0, 2.0, 1.0};
    const Case cases[] = {
        {triangle(), [](double s) { return s < 0.5 ? s : 1.0 - s; }},
        {trapezoid(0.25, 0.5),
         [](double s) {
             return std::min({s / 0.25, 1.0, (1.0 - s) / 0.5});
         }},
        {trapezoid(0.0, 1.0), [](double s) { return 1.0 - s; }},
        {trapezoid(1.0, 0.0), [](double s) { return s; }},
        {sampled(samples), [&](double s) {
             const double at = s * double(samples.size() - 1);
             const auto i = std::min(static_cast<size_t>(at), samples.size() - 2);
             return std::lerp(samples[i], samples[i + 1], at - double(i));
         }}};
    for (const Case& each : cases)
        for (const double u : {0.01, 0.1, 0.25, 0.4, 0.5, 0.62, 0.75, 0.9, 0.99}) {
            const double s = invertResponse(each.response, u);
            EXPECT_NEAR(integrate(each.height, s), u, 2e-5) << u;
            const auto table = computeResponseTable(each.response);
            EXPECT_NEAR(shader::cumulativeResponse({*table}, float(s)), u, 1e-6) << u;
        }
}

TEST(Response, TimesRiseFromOpenToCloseAndStayThere) {
    for (const ShutterResponse& response :
         {triangle(),
          trapezoid(0.5, 0.5),
          trapezoid(0.1, 0.0),
          sampled({0.0, 1.0}),
          sampled({1.0, 0.0}),
          sampledMost()}) {
        double last = 0.0;
        for (int i = 0; i <= 1000; ++i) {
            const double s = invertResponse(response, i / 1000.0);
            ASSERT_GE(s, last);
            ASSERT_LE(s, 1.0);
            last = s;
        }
        EXPECT_GT(last, 0.98);
        EXPECT_EQ(invertResponse(response, -0.1), invertResponse(response, 0.0));
        EXPECT_LE(invertResponse(response, 1.1), 1.0);
    }
}

TEST(Response, DarkStretchesAreSkippedAndResponsesOfEqualShapeAreEqual) {
    // Light in the middle fifth alone, flanks included.
    const ShutterResponse response = sampled({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
    for (int i = 1; i < 100; ++i) {
        const double s = invertResponse(response, i / 100.0);
        EXPECT_GT(s, 0.4);
        EXPECT_LT(s, 0.6);
    }
    EXPECT_NEAR(invertResponse(response, 0.0), 0.4, 1e-6) << "no light is taken at 0";
    for (const double height : {1e-300, 1.0, 1e300})
        EXPECT_NEAR(
            invertResponse(sampled({0.0, height, height}), 0.3),
            invertResponse(sampled({0.0, 1.0, 1.0}), 0.3),
            1e-7
        );
}

TEST(Response, LookUpsBeginAtTheLastKnotThatIsNotTooLateOrAtTheFirst) {
    for (const ShutterResponse& response :
         {triangle(), trapezoid(0.25, 0.5), sampled({0, 0, 0, 1, 0, 0, 5, 5, 0}), sampledMost()}) {
        const auto table = computeResponseTable(response);
        for (uint32_t cell = 0; cell < shader::kResponseCells; ++cell) {
            const double light = double(cell) / shader::kResponseCells;
            const uint32_t first = table->firstKnots[cell];
            EXPECT_LE(double(table->knots[first].cumulative), light);
            if (first + 2 < table->knotCount) {
                EXPECT_GT(double(table->knots[first + 1].cumulative), light) << cell;
            }
        }
    }
    const auto filled = computeResponseTable(sampledMost(11, 7));
    auto zero = filled;
    std::fill(std::begin(zero->firstKnots), std::end(zero->firstKnots), 0u);
    for (int i = -5; i <= 1005; ++i) {
        const float u = float(i) / 1000.0f;
        EXPECT_EQ(shader::inverseResponse({*zero}, u), shader::inverseResponse({*filled}, u)) << u;
    }
}

TEST(ExposurePart, APartsRasterInstantIsTheNearestToTheFrames) {
    CameraShutter shutter = makeShutter(ShutterMode::Angle);
    shutter.phase = ShutterPhase::Centre;
    const ExposureInterval whole = computeExposure(shutter, 2.0, 0.4); // from 1.9 to 2.1
    const ExposureInterval before = takePart(whole, 1.9, 1.95);
    EXPECT_EQ(before.raster, 1.95);
    EXPECT_EQ(before.rasterTime, 1.0);
    const ExposureInterval around = takePart(whole, 1.95, 2.05);
    EXPECT_EQ(around.raster, 2.0);
    EXPECT_NEAR(around.rasterTime, 0.5, 1e-12);
    const ExposureInterval after = takePart(whole, 2.05, 2.1);
    EXPECT_EQ(after.raster, 2.05);
    EXPECT_EQ(after.rasterTime, 0.0);
    for (const ExposureInterval& part : {before, around, after, takePart(around, 1.97, 1.98)}) {
        EXPECT_EQ(part.frame().open, whole.open);
        EXPECT_EQ(part.frame().raster, whole.raster);
        EXPECT_EQ(part.frame().close, whole.close);
        EXPECT_EQ(numberFrame(part), numberFrame(whole));
        EXPECT_EQ(computeExposureBefore(part, 2).raster, 2.0 - 0.8);
    }
}

TEST(ExposurePart, APartTakesItsShareOfTheLightAndIsUniformWithoutAny) {
    CameraShutter shutter = makeShutter(ShutterMode::Physical);
    shutter.exposureSeconds = 1.0;
    for (const ShutterResponse& response :
         {ShutterResponse{},
          triangle(),
          trapezoid(0.25, 0.5),
          trapezoid(0.0, 1.0),
          sampled({0.0, 5.0, 5.0, 0.0, 0.0, 2.0, 1.0}),
          sampled(std::vector<double>(64, 1.0))}) {
        shutter.response = response;
        const ExposureInterval whole = computeExposure(shutter, 1.0, 2.0); // from 0 to 1
        for (const auto& [from, to] :
             {std::pair{0.0, 0.3}, {0.3, 0.45}, {0.125, 1.0}, {0.0, 1.0}}) {
            const ExposureInterval part = takePart(whole, from, to);
            const double before = measureLightBefore(whole, from);
            const double light = measureLightBefore(whole, to) - before;
            for (const double u : {0.05, 0.3, 0.5, 0.8, 0.95}) {
                const double expected = invertResponse(response, before + u * light);
                EXPECT_NEAR(part.at(invertLight(part, u)), expected, 2e-4) << from << to << u;
                EXPECT_NEAR(measureLightBefore(part, expected), u, 2e-4) << from << to << u;
            }
            const std::vector<double> middles = middlesOfLight(part, 5);
            ASSERT_EQ(middles.size(), 5u);
            for (size_t i = 0; i < middles.size(); ++i)
                EXPECT_NEAR(
                    measureLightBefore(part, part.at(middles[i])), 0.1 + 0.2 * double(i), 2e-4
                ) << from
                  << to << i;
        }
    }
    shutter.response = sampled({1.0, 0.0, 0.0, 1.0});
    const ExposureInterval whole = computeExposure(shutter, 1.0, 2.0);
    EXPECT_EQ(invertLight(takePart(whole, 0.4, 0.6), 0.25), 0.25);
    EXPECT_EQ(measureLightBefore(whole, 0.4), measureLightBefore(whole, 0.6));
}

TEST(Response, BadOnesAreRefused) {
    using Samples = std::vector<double>;
    for (const ShutterResponse& good :
         {triangle(), trapezoid(0.5, 0.5), sampled({0.0, 1.0}), sampled(Samples(64, 1.0))})
        EXPECT_TRUE(validateResponse(good).ok());
    for (const auto& [open, close] :
         {std::pair{-0.1, 0.0}, {0.0, 1.1}, {kNan, 0.0}, {0.0, kNan}, {0.6, 0.5}})
        EXPECT_FALSE(validateResponse(trapezoid(open, close)).ok()) << open << ", " << close;
    for (const Samples& bad :
         {Samples{},
          {1.0},
          Samples(65, 1.0),
          {0.0, 0.0},
          {1.0, -0.5},
          {1.0, kNan},
          {1.0, kInfinity}})
        EXPECT_FALSE(validateResponse(sampled(bad)).ok()) << bad.size();
}

} // namespace
} // namespace shutter::scene
