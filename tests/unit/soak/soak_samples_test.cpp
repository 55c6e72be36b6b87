// SPDX-License-Identifier: MIT
#include "game/soak/soak_samples.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace shutter::soak {
namespace {

constexpr uint64_t kMiB = 1u << 20u;

/// A run of ten cycles that takes the same in each.
RunSamples makeFlat() {
    RunSamples samples;
    for (uint32_t cycle = 1; cycle <= 10; ++cycle) {
        CycleSample sample;
        sample.frameCount = 250 * cycle;
        sample.residentBytes = 300 * kMiB;
        sample.device = {64 * kMiB, 20, 30, 40, 5, 6};
        sample.wallMilliseconds = {8.0, 7.0, 9.0};
        sample.processorMilliseconds = {12.0, 11.0, 13.0};
        samples.push_back(sample);
    }
    return samples;
}

/// Names of the checks that are out of their bounds.
std::vector<std::string> listBroken(const RunSamples& samples, bool judgesProcessorTime = true) {
    std::vector<std::string> broken;
    for (const stability::Measured& row : judgeRun("run 1", samples, judgesProcessorTime))
        if (!stability::holds(row))
            broken.push_back(row.check);
    return broken;
}

using Names = std::vector<std::string>;

TEST(SoakSamples, AFlatRunHolds) {
    EXPECT_EQ(listBroken(makeFlat()), Names());
}

TEST(SoakSamples, TheFirstCycleDoesNotCount) {
    RunSamples samples = makeFlat();
    samples.front().residentBytes = 10 * kMiB;
    samples.front().device = {};
    samples.front().processorMilliseconds = {1.0, 1.0, 1.0};
    EXPECT_EQ(listBroken(samples), Names());
}

TEST(SoakSamples, MemoryOfTheProcessThatRisesIsNoticed) {
    RunSamples samples = makeFlat();
    for (size_t i = 0; i < samples.size(); ++i)
        *samples[i].residentBytes += i * 3 * kMiB;
    EXPECT_EQ(listBroken(samples), Names{"run 1: memory of the process gained"});
    // It may fall.
    std::reverse(samples.begin(), samples.end());
    EXPECT_EQ(listBroken(samples), Names());
}

TEST(SoakSamples, AnObjectOfTheDeviceACycleIsNoticed) {
    RunSamples samples = makeFlat();
    for (size_t i = 0; i < samples.size(); ++i)
        samples[i].device.buffers += uint32_t(i);
    EXPECT_EQ(listBroken(samples), Names{"run 1: buffers gained"});
    samples.back().device.memoryBytes += kMiB;
    EXPECT_EQ(listBroken(samples), (Names{"run 1: device memory gained", "run 1: buffers gained"}));
}

TEST(SoakSamples, WhatIsMadeWhenItIsFirstWantedIsNoGrowth) {
    RunSamples samples = makeFlat();
    for (size_t i = 5; i < samples.size(); ++i)
        samples[i].device.buffers += 1;
    EXPECT_EQ(listBroken(samples), Names());
}

TEST(SoakSamples, FramesThatBecomeSlowerAreNoticed) {
    RunSamples samples = makeFlat();
    for (size_t i = 0; i < samples.size(); ++i)
        samples[i].processorMilliseconds.median += double(i);
    EXPECT_EQ(listBroken(samples), Names{"run 1: time of a frame"});
    EXPECT_EQ(listBroken(samples, false), Names()); // the wall's clock says nothing of it
}

TEST(SoakSamples, ASystemThatDoesNotTellItsMemoryIsNotPassed) {
    RunSamples samples = makeFlat();
    for (CycleSample& sample : samples)
        sample.residentBytes.reset();
    EXPECT_EQ(listBroken(samples), Names{"run 1: memory of the process gained"});
}

TEST(SoakSamples, CurvesShowOneRunAfterTheOther) {
    const std::vector<demand::Curve> curves = drawCurves({makeFlat(), makeFlat()});
    ASSERT_EQ(curves.size(), 4u);
    for (const demand::Curve& curve : curves) {
        ASSERT_EQ(curve.points.size(), 20u) << curve.name;
        for (size_t i = 0; i < curve.points.size(); ++i)
            EXPECT_EQ(curve.points[i].x, 250.0 * double(i + 1)) << curve.name;
    }
    EXPECT_EQ(curves[0].points[3].y.median, 300.0);
    EXPECT_EQ(curves[1].points[3].y.median, 64.0);
}

} // namespace
} // namespace shutter::soak
