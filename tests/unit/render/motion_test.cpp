// SPDX-License-Identifier: MIT
#include "shaders/render/motion.glsl"

#include <gtest/gtest.h>

#include <limits>

namespace shutter::shader {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr vec2 kSize{200.0f, 100.0f};

} // namespace

TEST(Motion, TheMiddleOfClipSpaceIsTheMiddleOfThePicture) {
    EXPECT_EQ(screenFromClip(vec3(0.0f, 0.0f, 5.0f), kSize), vec2(100.0f, 50.0f));
    const vec2 corner = screenFromClip(vec3(-5.0f, -5.0f, 5.0f), kSize);
    EXPECT_NEAR(corner.x, 0.0f, 1e-4f);
    EXPECT_NEAR(corner.y, 0.0f, 1e-4f);
    const vec2 opposite = screenFromClip(vec3(5.0f, 5.0f, 5.0f), kSize);
    EXPECT_NEAR(opposite.x, 200.0f, 1e-4f);
    EXPECT_NEAR(opposite.y, 100.0f, 1e-4f);
}

TEST(Motion, APointAtRestHasNone) {
    const vec3 clip(0.3f, -0.2f, 2.0f);
    EXPECT_EQ(motionFromClip(clip, clip, clip, 0.1f, kSize), vec2(0.0f));
}

TEST(Motion, ItPointsFromOpenToCloseInPixelsRightAndDown) {
    const vec3 open(0.0f, 0.0f, 2.0f);
    const vec3 close(0.2f, 0.4f, 2.0f); // a tenth and a fifth of clip space, halves of the picture
    const vec2 motion = motionFromClip(open, close, close, 0.1f, kSize);
    EXPECT_NEAR(motion.x, 10.0f, 1e-4f);
    EXPECT_NEAR(motion.y, 10.0f, 1e-4f);
    const vec2 back = motionFromClip(close, open, open, 0.1f, kSize);
    EXPECT_NEAR(back.x, -10.0f, 1e-4f);
    EXPECT_NEAR(back.y, -10.0f, 1e-4f);
}

TEST(Motion, APointInFrontIsNotPulled) {
    const vec3 clip(1.0f, 2.0f, 0.1f);
    EXPECT_EQ(pullInFront(clip, vec3(0.0f, 0.0f, 3.0f), 0.1f), clip);
}

TEST(Motion, APointBehindIsPulledToWhereItsPathCrossesTheNearPlane) {
    const vec3 visible(4.0f, 2.0f, 3.0f);
    const vec3 behind(-4.0f, 6.0f, -1.0f);
    // w falls from 3 to -1; it is 1 half of the way.
    const vec3 pulled = pullInFront(behind, visible, 1.0f);
    EXPECT_NEAR(pulled.x, 0.0f, 1e-5f);
    EXPECT_NEAR(pulled.y, 4.0f, 1e-5f);
    EXPECT_NEAR(pulled.z, 1.0f, 1e-5f);
}

TEST(Motion, APointThatWasBehindTheCameraGetsAFiniteMotionInTheRightDirection) {
    const vec3 visible(0.5f, 0.0f, 1.0f);
    const vec3 behind(0.5f, 0.0f, -4.0f);
    // Came from behind, passing at the right: in the picture it moves from the far right inwards.
    const vec2 motion = motionFromClip(behind, visible, visible, 0.05f, kSize);
    EXPECT_LT(motion.x, 0.0f);
    EXPECT_EQ(motion.y, 0.0f);
    EXPECT_TRUE(isFinite(motion.x));
}

TEST(Motion, ItIsNeverLongerThanWhatIsStoredAndKeepsItsDirection) {
    const vec3 near(0.0f, 0.0f, 1.0f);
    const vec3 far(3.0e6f, 4.0e6f, 1.0f);
    const vec2 motion = motionFromClip(near, far, near, 0.1f, vec2(100.0f));
    EXPECT_NEAR(length(motion), kMaxMotionPx, 1.0f);
    EXPECT_NEAR(motion.y / motion.x, 4.0f / 3.0f, 1e-4f);
}

TEST(Motion, WhatIsNotFiniteCountsAsStill) {
    const vec3 clip(0.1f, 0.2f, 1.0f);
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        EXPECT_EQ(motionFromClip(vec3(bad, 0.0f, 1.0f), clip, clip, 0.1f, kSize), vec2(0.0f));
        EXPECT_EQ(motionFromClip(clip, vec3(0.0f, bad, 1.0f), clip, 0.1f, kSize), vec2(0.0f));
    }
    EXPECT_EQ(motionFromClip(vec3(0.0f, 0.0f, kNan), clip, clip, 0.1f, kSize), vec2(0.0f));
}

} // namespace shutter::shader
