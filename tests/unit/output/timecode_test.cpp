// SPDX-License-Identifier: MIT
#include "game/output/timecode.h"

#include <gtest/gtest.h>

#include <string>

namespace shutter::game {
namespace {

RenderOptions makeOptions(const std::string& timecode, core::FrameRate fps) {
    RenderOptions options;
    options.output.video.timecode = timecode;
    options.shot.fps = fps;
    return options;
}

/// The code of a frame, or why it has none; "-" without --timecode.
std::string find(const RenderOptions& options, size_t frame) {
    const auto found = findTimecode(options, frame);
    if (!found)
        return found.error().message;
    return found.value() ? describe(*found.value()) : "-";
}

} // namespace

TEST(TimecodeTest, CountsFramesSecondsMinutesHoursAndDays) {
    const RenderOptions options = makeOptions("01:02:03:20", 24.0);
    EXPECT_EQ(find(options, 0), "01:02:03:20");
    EXPECT_EQ(find(options, 3), "01:02:03:23");
    EXPECT_EQ(find(options, 4), "01:02:04:00");
    EXPECT_EQ(find(options, 24 * 57), "01:03:00:20");
    EXPECT_EQ(find(makeOptions("23:59:59:29", 29.97), 1), "00:00:00:00");
    EXPECT_EQ(find(makeOptions("00:59:59:20", {24000.0, 1001.0}), 24), "01:00:00:20");
    EXPECT_EQ(find(makeOptions("", 24.0), 5), "-");
}

TEST(TimecodeTest, OfTheFramesNumberBeginsWithIt) {
    RenderOptions options = makeOptions("frame", 25.0);
    options.shot.firstFrame = 1001;
    EXPECT_EQ(find(options, 0), "00:00:40:01");
    EXPECT_EQ(find(options, 24), "00:00:41:00");
    options.shot.firstFrame = -1;
    EXPECT_EQ(find(options, 0), "--timecode frame: frame -1 has none");
}

TEST(TimecodeTest, WhatNoClockShowsIsRefused) {
    EXPECT_EQ(
        find(makeOptions("00:00:00:24", 24.0), 0),
        "--timecode 00:00:00:24: a second has 24 frames, numbered from 0"
    );
    EXPECT_EQ(
        find(makeOptions("24:00:00:00", 24.0), 0),
        "--timecode 24:00:00:00: a day has 24 hours, numbered from 0"
    );
    EXPECT_EQ(
        find(makeOptions("00:00:00:00", 60.0), 0),
        "--timecode: an EXR's counts 30 frames a second at most, and --fps is 60"
    );
    EXPECT_EQ(
        find(makeOptions("00:00:00:00", {60000.0, 1001.0}), 0),
        "--timecode: an EXR's counts 30 frames a second at most, and --fps is 60000/1001"
    );
    EXPECT_EQ(
        find(makeOptions("00:00:00:01", 1.0), 0),
        "--timecode 00:00:00:01: a second has 1 frame, numbered from 0"
    );
    RenderOptions film = makeOptions("00:00:00:59", 60.0);
    film.output.film = "film.mp4";
    EXPECT_EQ(find(film, 1), "00:00:01:00");
}

TEST(FrameStampTest, IsOfFramesOfASequenceAlone) {
    RenderOptions options = makeOptions("01:02:03:20", {24000.0, 1001.0});
    options.shot.isSequence = true;
    const auto stamp = findStamp(options, 4);
    ASSERT_TRUE(stamp.ok() && stamp.value());
    EXPECT_EQ(stamp.value()->rate, core::FrameRate(24000.0, 1001.0));
    EXPECT_EQ(describe(stamp.value()->timecode.value()), "01:02:04:00");
    options.output.video.timecode.clear();
    const auto untimed = findStamp(options, 0);
    ASSERT_TRUE(untimed.ok() && untimed.value());
    EXPECT_FALSE(untimed.value()->timecode);
    options.shot.isSequence = false;
    const auto single = findStamp(options, 0);
    ASSERT_TRUE(single.ok());
    EXPECT_FALSE(single.value());
}

} // namespace shutter::game
