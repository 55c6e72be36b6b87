// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/ray_share.glsl"

#include <gtest/gtest.h>

#include <cstdint>

namespace shutter::shader {

namespace {

constexpr int kSide = 240;

/// Rays over all blocks where every pixel is masked, of as many pixels.
double traceEverything(float rayShare) {
    double rays = 0.0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const uint32_t tracing = chooseTracing({float(x), float(y)}, rayShare);
            rays += tracing == kTracePixels ? 1.0 : tracing == kTraceQuads ? kQuadShare : 0.0;
        }
    return rays / (kSide * kSide);
}

} // namespace

TEST(RayShare, AllBlocksTogetherTraceTheShare) {
    for (const float share : {0.0f, 0.01f, 0.1f, 0.25f, 0.26f, 0.5f, 0.75f, 0.99f, 1.0f})
        EXPECT_NEAR(traceEverything(share), share, 0.01) << share;
}

TEST(RayShare, OneTracesEveryPixelAndZeroNone) {
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            ASSERT_EQ(chooseTracing({float(x), float(y)}, 1.0f), kTracePixels);
            ASSERT_EQ(chooseTracing({float(x), float(y)}, 0.0f), kTraceNothing);
        }
}

TEST(RayShare, ALargerShareTakesNothingFromAnyBlock) {
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
            for (int i = 0; i < 20; ++i) // kTracePixels is the least number
                ASSERT_GE(
                    chooseTracing({float(x), float(y)}, float(i) / 20.0f),
                    chooseTracing({float(x), float(y)}, float(i + 1) / 20.0f)
                );
}

} // namespace shutter::shader
