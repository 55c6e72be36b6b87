// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/figures.h"

#include <gtest/gtest.h>

namespace shutter::demand {

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

} // namespace shutter::demand
