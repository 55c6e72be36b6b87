// SPDX-License-Identifier: MIT
#include "assets/generator/hard_cases.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

namespace shutter::generator {
namespace {

TEST(HardCases, AreTheTwelveThatTheBenchPromises) {
    std::set<std::string_view> names;
    for (const BenchCase& hardCase : listHardCases())
        names.insert(hardCase.name);
    const std::set<std::string_view> promised = {
        "translation",
        "spin",
        "wheel_spokes",
        "camera_pan",
        "camera_dolly",
        "camera_orbit",
        "crossing_same_colour",
        "static_post",
        "self_overlap",
        "long_motion",
        "thin_geometry",
        "sky_horizon"};
    EXPECT_EQ(names, promised);
    EXPECT_EQ(listHardCases().size(), promised.size()) << "a name stands twice";
}

TEST(HardCases, HaveTitlesToTellThemApart) {
    std::set<std::string_view> titles;
    for (const BenchCase& hardCase : listHardCases())
        titles.insert(hardCase.title);
    EXPECT_EQ(titles.size(), listHardCases().size());
}

TEST(HardCases, DescribeThemselvesInOneSentenceThatStatesTheMotion) {
    for (const BenchCase& hardCase : listHardCases()) {
        SCOPED_TRACE(hardCase.name);
        const std::string& text = hardCase.description;
        EXPECT_EQ(std::count(text.begin(), text.end(), '.'), 1) << text;
        EXPECT_TRUE(text.ends_with("px at 640x360.")) << text;
        const glm::vec2 peak = hardCase.peakMotionPx;
        EXPECT_NE(text.find(fmt::format("{} to {} px", peak.x, peak.y)), std::string::npos) << text;
        EXPECT_GT(peak.x, 0.0f);
        EXPECT_LT(peak.x, peak.y);
    }
}

TEST(HardCases, LeaveRoomForEightTimesTheExposureBeforeTheirTime) {
    for (const BenchCase& hardCase : listHardCases()) {
        EXPECT_GT(hardCase.exposureSeconds, 0.0) << hardCase.name;
        // Clips hold before time 0: an exposure that began earlier would see them stop.
        EXPECT_GE(hardCase.timeSeconds - 8.0 * hardCase.exposureSeconds, 0.0) << hardCase.name;
        EXPECT_EQ(std::string_view(hardCase.phase), "end") << hardCase.name;
    }
}

} // namespace
} // namespace shutter::generator
