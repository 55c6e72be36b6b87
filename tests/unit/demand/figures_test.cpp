// SPDX-License-Identifier: MIT
// Figures that the tests of demand compare.
#include "tests/conformance/demand/figures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::demand {
namespace {

using render::PassOwner;

render::FrameStatistics makeFrame(std::vector<render::PassTime> passes) {
    render::FrameStatistics frame;
    frame.passes = std::move(passes);
    return frame;
}

const render::FrameStatistics kHybrid = makeFrame(
    {{{"G-buffer", 100.0}, PassOwner::Scene},
     {{"build TLAS", 1.0}, PassOwner::Rays},
     {{"tile max", 2.0}, PassOwner::Blur},
     {{"neighbour max", 3.0}, PassOwner::Blur},
     {{"edge", 4.0}, PassOwner::Blur},
     {{"ray mask", 5.0}, PassOwner::Blur},
     {{"gather without mask", 6.0}, PassOwner::Blur},
     {{"ray reveal", 7.0}, PassOwner::Blur},
     {{"tiles of reveal", 8.0}, PassOwner::Blur},
     {{"gather and composite", 9.0}, PassOwner::Blur},
     {{"tone map", 50.0}, PassOwner::Display},
     {{"readback display", 60.0}, PassOwner::Display}}
);

TEST(Figures, PassesAreCountedOnceWhereTheyBelong) {
    EXPECT_EQ(effectOf(*game::findMethod("hybrid").value())(kHybrid), 45.0);
    EXPECT_EQ(effectOf(*game::findMethod("sharp").value())(kHybrid), 0.0);
    EXPECT_EQ(sumPasses(kHybrid, isMaskOrReveal), 24.0);
    EXPECT_EQ(sumPasses(kHybrid, isReveal), 7.0);
}

TEST(Figures, RatiosAreTakenRoundByRound) {
    const auto wall = [](const render::FrameStatistics& frame) { return frame.wallMilliseconds; };
    Frames a(3);
    Frames b(3);
    const double times[] = {1.0, 10.0, 100.0};
    for (size_t i = 0; i < 3; ++i) {
        a[i].wallMilliseconds = (2.0 + double(i)) * times[i];
        b[i].wallMilliseconds = times[i];
    }
    EXPECT_EQ(compare(a, b, wall, wall).median, 3.0);
    b[1].wallMilliseconds = 0.0;
    const math::Quartiles ratio = compare(a, b, wall, wall);
    EXPECT_FALSE(stability::holds(checkMedian("c", ratio, 1e9, "", 3)))
        << "nothing to compare with";
}

TEST(Figures, AMedianBeyondItsBoundOrNoNumberBreaks) {
    EXPECT_TRUE(stability::holds(checkMedian("c", {1.0, 0.5, 1.5}, 1.0, "", 7)));
    EXPECT_FALSE(stability::holds(checkMedian("c", {1.01, 0.5, 1.5}, 1.0, "", 7)));
    EXPECT_FALSE(stability::holds(checkMedian("c", {std::nan(""), 0.5, 1.5}, 1.0, "", 7)));
    EXPECT_EQ(
        checkMedian("c", {1.0, 0.5, 1.5}, 1.0, "", 7, "more").note,
        "7 rounds, quartiles 0.5 to 1.5; more"
    );
}

TEST(Figures, ALineHoldsFromR2Of098) {
    std::vector<math::CurvePoint> points;
    for (const double x : {0.0, 1.0, 2.0, 3.0})
        points.push_back({x, 2.0 * x + 1.0});
    const stability::Measured row = checkLine("line", points, "pixel");
    EXPECT_TRUE(stability::holds(row));
    EXPECT_EQ(row.note, "1 ms and 2 a pixel");
    points.back().y = 3.0;
    EXPECT_FALSE(stability::holds(checkLine("line", points, "pixel")));
    points.resize(3);
    EXPECT_FALSE(stability::holds(checkLine("line", points, "pixel")));
}

using Lines = std::vector<std::string>;

TEST(GraphParts, FindsPassesImagesAndBuffersAndNothingElse) {
    const GraphParts parts = readDump("passes: 2\n"
                                      "  0 'G-buffer' (raster)\n"
                                      "      barrier 'color' nothing -> colour\n"
                                      "      clears 'color' to version 1: colour target\n"
                                      "  1 'tone map' (compute, side effect)\n"
                                      "  end: barrier 'color' compute -> all\n"
                                      "culled: 1\n"
                                      "  'gather': nobody reads it\n"
                                      "images: 1\n"
                                      "  'color' 4 x 2 R8_UNORM, passes 0 to 1, 64 bytes at 0\n"
                                      "buffers: 1\n"
                                      "  'list', passes 0 to 1, 16 bytes\n"
                                      "image memory: 64 bytes, 64 without sharing\n");
    EXPECT_EQ(parts.passes, (Lines{"'G-buffer' (raster)", "'tone map' (compute, side effect)"}));
    EXPECT_EQ(parts.images, (Lines{"'color' 4 x 2 R8_UNORM, passes 0 to 1, 64 bytes at 0"}));
    EXPECT_EQ(parts.buffers, (Lines{"'list', passes 0 to 1, 16 bytes"}));
}

TEST(GraphParts, AnEmptyDumpHasNoParts) {
    const GraphParts parts = readDump("");
    EXPECT_TRUE(parts.passes.empty());
    EXPECT_TRUE(parts.images.empty());
    EXPECT_TRUE(parts.buffers.empty());
}

TEST(GraphParts, EveryLineAnswersForOneOfItsEqualsOnly) {
    EXPECT_EQ(countBeyond({}, {"a"}), 0u);
    EXPECT_EQ(countBeyond({"a", "b"}, {"b", "a"}), 0u);
    EXPECT_EQ(countBeyond({"a", "a", "c"}, {"a", "b"}), 2u);
}

} // namespace
} // namespace shutter::demand
