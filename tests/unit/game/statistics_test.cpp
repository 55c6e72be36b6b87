// SPDX-License-Identifier: MIT
#include "game/statistics.h"

#include <gtest/gtest.h>

namespace shutter::game {

namespace {

render::FrameStatistics makeFrame(double milliseconds) {
    render::FrameStatistics frame;
    frame.passes = {{"draw", milliseconds, 2.0 * milliseconds}, {"blur", 10.0, 1.0}};
    frame.cpuMilliseconds = 3.0 * milliseconds;
    frame.wallMilliseconds = 4.0 * milliseconds;
    frame.counters = {{"rays traced", 5}};
    frame.transientBytes = static_cast<uint64_t>(milliseconds) * 100;
    return frame;
}

render::FrameStatistics medianOf(const std::vector<double>& milliseconds) {
    std::vector<render::FrameStatistics> frames;
    for (const double value : milliseconds)
        frames.push_back(makeFrame(value));
    return computeMedian(frames);
}

} // namespace

TEST(Statistics, TheMedianOfOneIsItself) {
    EXPECT_EQ(medianOf({7.0}).passes.at(0).gpuMilliseconds, 7.0);
}

TEST(Statistics, TheMedianOfAnOddNumberIsTheMiddleWhateverTheOrder) {
    const render::FrameStatistics median = medianOf({100.0, 1.0, 3.0});
    EXPECT_EQ(median.passes.at(0).gpuMilliseconds, 3.0);
    EXPECT_EQ(median.passes.at(0).cpuMilliseconds, 6.0);
    EXPECT_EQ(median.cpuMilliseconds, 9.0);
    EXPECT_EQ(median.wallMilliseconds, 12.0);
    EXPECT_EQ(median.passes.at(1).gpuMilliseconds, 10.0);
}

TEST(Statistics, TheMedianOfAnEvenNumberIsBetweenTheTwoInTheMiddle) {
    EXPECT_EQ(medianOf({4.0, 100.0, 2.0, 1.0}).wallMilliseconds, 12.0);
}

TEST(Statistics, SumsAreByPassNameInTheOrderOfFirstAppearance) {
    render::FrameStatistics total;
    addStatistics(total, makeFrame(1.0));
    render::FrameStatistics next = makeFrame(2.0);
    next.passes = {{"blur", 5.0, 1.0}, {"tone map", 7.0, 1.0}, {"draw", 2.0, 4.0}};
    next.decisions = {{"motion blur", "ran: later"}};
    addStatistics(total, next);
    ASSERT_EQ(total.passes.size(), 3u);
    EXPECT_EQ(total.passes[0].name, "draw");
    EXPECT_EQ(total.passes[0].gpuMilliseconds, 3.0);
    EXPECT_EQ(total.passes[0].cpuMilliseconds, 6.0);
    EXPECT_EQ(total.passes[1].gpuMilliseconds, 15.0);
    EXPECT_EQ(total.passes[2].name, "tone map");
    EXPECT_EQ(total.cpuMilliseconds, 9.0);
    EXPECT_EQ(total.wallMilliseconds, 12.0);
    EXPECT_EQ(total.counters.at("rays traced"), 10u);
    EXPECT_EQ(total.decisions.at("motion blur"), "ran: later");
}

TEST(Statistics, MemoryIsUsedAgainSoItsSumIsItsMaximum) {
    render::FrameStatistics total;
    addStatistics(total, makeFrame(5.0));
    addStatistics(total, makeFrame(2.0));
    EXPECT_EQ(total.transientBytes, 500u);
}

} // namespace shutter::game
