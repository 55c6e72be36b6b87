// SPDX-License-Identifier: MIT
#include "engine/extract/demand.h"

#include <gtest/gtest.h>

namespace shutter::extract {

namespace {

DrawItem makeDraw(scene::AlphaMode mode) {
    DrawItem draw;
    draw.alphaMode = mode;
    return draw;
}

} // namespace

TEST(Demand, AFrameOfPlainMeshesAsksForNothingMore) {
    ExtractedFrame frame;
    frame.opaque.still.push_back(makeDraw(scene::AlphaMode::Opaque));
    const SurfaceDemand demand = decideSurfaces(frame);
    EXPECT_FALSE(demand.deformation.run);
    EXPECT_FALSE(demand.alphaMask.run);
    EXPECT_FALSE(demand.blending.run);
    EXPECT_EQ(describe(demand.alphaMask), "skipped: no surface in the picture has an alpha mask");
}

TEST(Demand, WhatIsDrawnAsksForWhatItNeedsAndSaysHowMuchOfItThereIs) {
    ExtractedFrame frame;
    frame.opaque.still.assign(2, makeDraw(scene::AlphaMode::Mask));
    frame.blended.moving.push_back(makeDraw(scene::AlphaMode::Blend));
    frame.deformed.resize(3);
    const SurfaceDemand demand = decideSurfaces(frame);
    EXPECT_EQ(describe(demand.deformation), "ran: 3 drawn entities with a skin or morph targets");
    EXPECT_EQ(describe(demand.alphaMask), "ran: 2 draws in the picture with an alpha mask");
    EXPECT_EQ(describe(demand.blending), "ran: 1 blended draw in the picture");
}

} // namespace shutter::extract
