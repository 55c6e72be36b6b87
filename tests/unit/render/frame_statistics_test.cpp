// SPDX-License-Identifier: MIT
#include "engine/render/frame_statistics.h"

#include <gtest/gtest.h>

#include <vector>

namespace shutter::render {

namespace {

FrameStatistics makeFrame(double milliseconds) {
    FrameStatistics frame;
    frame.passes = {{"draw", milliseconds, 2.0 * milliseconds}, {"blur", 10.0, 1.0}};
    frame.cpuMilliseconds = 3.0 * milliseconds;
    frame.wallMilliseconds = 4.0 * milliseconds;
    frame.counters = {{"rays traced", 5}};
    frame.transientBytes = static_cast<uint64_t>(milliseconds) * 100;
    return frame;
}

FrameStatistics medianOf(const std::vector<double>& milliseconds) {
    std::vector<FrameStatistics> frames;
    for (const double value : milliseconds)
        frames.push_back(makeFrame(value));
    return computeMedian(frames);
}

} // namespace

TEST(FrameStatistics, TheMedianOfOneIsItself) {
    EXPECT_EQ(medianOf({7.0}).passes.at(0).gpuMilliseconds, 7.0);
}

TEST(FrameStatistics, TheMedianOfAnOddNumberIsTheMiddleWhateverTheOrder) {
    const FrameStatistics median = medianOf({100.0, 1.0, 3.0});
    EXPECT_EQ(median.passes.at(0).gpuMilliseconds, 3.0);
    EXPECT_EQ(median.passes.at(0).cpuMilliseconds, 6.0);
    EXPECT_EQ(median.cpuMilliseconds, 9.0);
    EXPECT_EQ(median.wallMilliseconds, 12.0);
    EXPECT_EQ(median.passes.at(1).gpuMilliseconds, 10.0);
}

TEST(FrameStatistics, TheMedianOfAnEvenNumberIsBetweenTheTwoInTheMiddle) {
    EXPECT_EQ(medianOf({4.0, 100.0, 2.0, 1.0}).wallMilliseconds, 12.0);
}

TEST(FrameStatistics, SumsAreByPassNameInTheOrderOfFirstAppearance) {
    FrameStatistics total;
    addStatistics(total, makeFrame(1.0));
    FrameStatistics next = makeFrame(2.0);
    next.passes = {{"blur", 5.0, 1.0}, {"tone map", 7.0, 1.0}, {"draw", 2.0, 4.0}};
    next.explanations = {{ExplainedKind::Effect, "motion blur", {true, "later"}}};
    total.measures = {{"standard error", 0.5}, {"other", 2.0}};
    next.measures = {{"standard error", 0.25}};
    addStatistics(total, next);
    EXPECT_EQ(total.measures.at("standard error"), 0.25) << "the later frame's";
    EXPECT_EQ(total.measures.at("other"), 2.0);
    ASSERT_EQ(total.passes.size(), 3u);
    EXPECT_EQ(total.passes[0].name, "draw");
    EXPECT_EQ(total.passes[0].gpuMilliseconds, 3.0);
    EXPECT_EQ(total.passes[0].cpuMilliseconds, 6.0);
    EXPECT_EQ(total.passes[1].gpuMilliseconds, 15.0);
    EXPECT_EQ(total.passes[2].name, "tone map");
    EXPECT_EQ(total.cpuMilliseconds, 9.0);
    EXPECT_EQ(total.wallMilliseconds, 12.0);
    EXPECT_EQ(total.counters.at("rays traced"), 10u);
    const core::Decision* blur = findDecision(total.explanations, "motion blur");
    ASSERT_NE(blur, nullptr);
    EXPECT_EQ(core::describe(*blur), "ran: later");
}

TEST(FrameStatistics, MemoryIsUsedAgainSoItsSumIsItsMaximum) {
    FrameStatistics total;
    addStatistics(total, makeFrame(5.0));
    addStatistics(total, makeFrame(2.0));
    EXPECT_EQ(total.transientBytes, 500u);
}

} // namespace shutter::render
