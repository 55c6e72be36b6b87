// SPDX-License-Identifier: MIT
// Motion of points, rays at triangles, and numbers that are none.
#include "engine/math/math.h"
#include "shaders/common/numeric.glsl"
#include "shaders/render/motion.glsl"
#include "shaders/render/ray_triangle.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ios>
#include <limits>
#include <random>

namespace shutter::shader {
namespace {

using math::dvec3;

constexpr float kQuietNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kPlusInfinity = std::numeric_limits<float>::infinity();
constexpr vec2 kPictureSize{200.0f, 100.0f};

TEST(Motion, TheMiddleOfClipSpaceIsTheMiddleOfThePicture) {
    EXPECT_EQ(screenFromClip(vec3(0.0f, 0.0f, 5.0f), kPictureSize), vec2(100.0f, 50.0f));
    const vec2 corner = screenFromClip(vec3(-5.0f, -5.0f, 5.0f), kPictureSize);
    EXPECT_NEAR(corner.x, 0.0f, 1e-4f);
    EXPECT_NEAR(corner.y, 0.0f, 1e-4f);
    const vec2 opposite = screenFromClip(vec3(5.0f, 5.0f, 5.0f), kPictureSize);
    EXPECT_NEAR(opposite.x, 200.0f, 1e-4f);
    EXPECT_NEAR(opposite.y, 100.0f, 1e-4f);
}

TEST(Motion, APointAtRestHasNoMotion) {
    const vec3 clip(0.3f, -0.2f, 2.0f);
    EXPECT_EQ(motionFromClip(clip, clip, clip, 0.1f, kPictureSize), vec2(0.0f));
}

TEST(Motion, MotionPointsFromOpenToCloseInPixelsRightAndDown) {
    const vec3 open(0.0f, 0.0f, 2.0f);
    const vec3 close(0.2f, 0.4f, 2.0f); // a tenth and a fifth of clip space, halves of the picture
    const vec2 motion = motionFromClip(open, close, close, 0.1f, kPictureSize);
    EXPECT_NEAR(motion.x, 10.0f, 1e-4f);
    EXPECT_NEAR(motion.y, 10.0f, 1e-4f);
    const vec2 back = motionFromClip(close, open, open, 0.1f, kPictureSize);
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
    const vec2 motion = motionFromClip(behind, visible, visible, 0.05f, kPictureSize);
    EXPECT_LT(motion.x, 0.0f);
    EXPECT_EQ(motion.y, 0.0f);
    EXPECT_TRUE(isFinite(motion.x));
}

TEST(Motion, MotionIsClampedToTheStorableLengthInItsDirection) {
    const vec3 near(0.0f, 0.0f, 1.0f);
    const vec3 far(3.0e6f, 4.0e6f, 1.0f);
    const vec2 motion = motionFromClip(near, far, near, 0.1f, vec2(100.0f));
    EXPECT_NEAR(length(motion), kMaxMotionPx, 1.0f);
    EXPECT_NEAR(motion.y / motion.x, 4.0f / 3.0f, 1e-4f);
}

TEST(Motion, NonFiniteMotionCountsAsStatic) {
    const vec3 clip(0.1f, 0.2f, 1.0f);
    for (const float bad : {kQuietNan, kPlusInfinity, -kPlusInfinity}) {
        EXPECT_EQ(
            motionFromClip(vec3(bad, 0.0f, 1.0f), clip, clip, 0.1f, kPictureSize), vec2(0.0f)
        );
        EXPECT_EQ(
            motionFromClip(clip, vec3(0.0f, bad, 1.0f), clip, 0.1f, kPictureSize), vec2(0.0f)
        );
    }
    EXPECT_EQ(
        motionFromClip(vec3(0.0f, 0.0f, kQuietNan), clip, clip, 0.1f, kPictureSize), vec2(0.0f)
    );
}

class Random {
  public:
    vec3 operator()() { return {mValue(mEngine), mValue(mEngine), mValue(mEngine)}; }

  private:
    std::mt19937 mEngine{11};
    std::uniform_real_distribution<float> mValue{-1.0f, 1.0f};
};

TEST(RayTriangle, HitsAgreeWithDoublePrecision) {
    Random random;
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 origin = 2.0f * random();
        const vec3 direction = random() * 3.0f;
        const vec3 a = random();
        const vec3 b = random();
        const vec3 c = random();
        const TriangleHit hit = intersectTriangle(origin, direction, a, b, c);
        const math::dmat3 columns(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a), -dvec3(direction));
        const double determinant = glm::determinant(columns);
        if (std::abs(determinant) < 1e-3)
            continue; // seen from its edge
        const dvec3 uvt = glm::inverse(columns) * (dvec3(origin) - dvec3(a));
        const double inside = std::min({uvt.x, uvt.y, 1.0 - uvt.x - uvt.y});
        if (std::abs(inside) < 1e-4)
            continue; // either may be right
        ASSERT_EQ(hit.found, inside > 0.0) << i;
        if (!hit.found)
            continue;
        ++hits;
        EXPECT_NEAR(hit.t, uvt.z, 1e-3);
        EXPECT_NEAR(hit.barycentrics.x, uvt.x, 1e-3);
        EXPECT_NEAR(hit.barycentrics.y, uvt.y, 1e-3);
        const dvec3 normal = glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a));
        EXPECT_EQ(hit.frontFace, glm::dot(normal, dvec3(direction)) < 0.0);
    }
    EXPECT_GT(hits, 300);
}

TEST(RayTriangle, NoRayGetsThroughASharedEdgeOrCorner) {
    // A fan of triangles around a corner, in general position; rays at points of its inner edges.
    Random random;
    for (int fan = 0; fan < 200; ++fan) {
        const vec3 centre = 0.1f * random();
        vec3 rim[6];
        for (int i = 0; i < 6; ++i) {
            const float angle = 1.0472f * float(i);
            rim[i] = vec3(std::cos(angle), std::sin(angle), 0.0f) + 0.2f * random();
        }
        const vec3 origin = vec3(0.0f, 0.0f, 3.0f) + 0.5f * random();
        for (int i = 0; i < 6; ++i)
            for (int step = 0; step <= 20; ++step) {
                const vec3 at = mix(centre, rim[i], 0.045f * float(step));
                const vec3 direction = at - origin;
                bool met = false;
                for (int k = 0; k < 6; ++k)
                    met = met ||
                          intersectTriangle(origin, direction, centre, rim[k], rim[(k + 1) % 6])
                              .found;
                ASSERT_TRUE(met) << fan << ", " << i << ", " << step;
            }
    }
}

TEST(RayTriangle, TheSignOfTIsInFrontOrBehind) {
    const vec3 a(-1, -1, -2);
    const vec3 b(1, -1, -2);
    const vec3 c(0, 1, -2);
    const TriangleHit front = intersectTriangle(vec3(0), vec3(0, 0, -0.5f), a, b, c);
    EXPECT_TRUE(front.found);
    EXPECT_FLOAT_EQ(front.t, 4.0f);
    EXPECT_TRUE(front.frontFace);
    const TriangleHit behind = intersectTriangle(vec3(0), vec3(0, 0, 1), a, b, c);
    EXPECT_TRUE(behind.found);
    EXPECT_FLOAT_EQ(behind.t, -2.0f);
    EXPECT_FALSE(behind.frontFace);
    EXPECT_FALSE(intersectTriangle(vec3(0), vec3(0, 0, -1), a, c, b).frontFace);
}

TEST(RayTriangle, DegenerateTrianglesAreNotHit) {
    const vec3 a(-1, -1, -2);
    const vec3 b(1, -1, -2);
    const vec3 c(0, 1, -2);
    const vec3 ahead(0, 0, -1);
    EXPECT_TRUE(intersectTriangle(vec3(0), ahead, a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), vec3(0), a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), vec3(kQuietNan, 0, -1), a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), vec3(0, 0, -kPlusInfinity), a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(kQuietNan), ahead, a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, a, b, vec3(kQuietNan)).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, a, b, vec3(0, kPlusInfinity, -2)).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, c, c, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0, -1, 0), ahead, a, b, b).found);
    // In the plane of the ray.
    EXPECT_FALSE(
        intersectTriangle(vec3(0), ahead, vec3(0, 0, -1), vec3(0, 0, -2), vec3(0, 1, -2)).found
    );
}

TEST(Numeric, SaturateCutsBothEndsOff) {
    EXPECT_EQ(saturate(-1.0f), 0.0f);
    EXPECT_EQ(saturate(0.25f), 0.25f);
    EXPECT_EQ(saturate(7.0f), 1.0f);
    EXPECT_EQ(saturate(kPlusInfinity), 1.0f);
    EXPECT_EQ(saturate(-kPlusInfinity), 0.0f);
}

TEST(Numeric, LuminanceIsRec709sAndOneForWhite) {
    EXPECT_FLOAT_EQ(luminance(vec3(1.0f)), 1.0f);
    EXPECT_FLOAT_EQ(luminance(vec3(1.0f, 0.0f, 0.0f)), 0.2126f);
    EXPECT_FLOAT_EQ(luminance(vec3(0.0f, 2.0f, 0.0f)), 2.0f * 0.7152f);
    EXPECT_FLOAT_EQ(luminance(vec3(0.0f, 0.0f, 1.0f)), 0.0722f);
}

TEST(Numeric, NanAndInfinityAreNotFinite) {
    EXPECT_FALSE(isFinite(kQuietNan));
    EXPECT_FALSE(isFinite(kPlusInfinity));
    EXPECT_FALSE(isFinite(-kPlusInfinity));
    EXPECT_TRUE(isFinite(0.0f));
    EXPECT_TRUE(isFinite(-3.4e38f));
    EXPECT_FALSE(isFinite(-kQuietNan));
    EXPECT_TRUE(isFinite(std::numeric_limits<float>::denorm_min()));
    EXPECT_TRUE(isFinite(std::numeric_limits<float>::max()));
    EXPECT_TRUE(isFinite(std::numeric_limits<float>::lowest()));
}

TEST(Numeric, OnlyNanIsNotANumber) {
    // Quiet and signalling, of either sign, with the smallest and the largest payload.
    for (const uint bits : {0x7FC00000u, 0x7F800001u, 0x7FFFFFFFu, 0xFFC00000u, 0xFF800001u})
        EXPECT_TRUE(isNotANumber(uintBitsToFloat(bits))) << std::hex << bits;
    for (const float x : {0.0f, -0.0f, 1.0f, std::numeric_limits<float>::max(), kPlusInfinity})
        EXPECT_FALSE(isNotANumber(x) || isNotANumber(-x)) << x;
}

TEST(Numeric, AStorableColourStaysAsItIs) {
    EXPECT_EQ(storableColor(vec3(0.0f, 0.5f, 64999.0f)), vec3(0.0f, 0.5f, 64999.0f));
}

TEST(Numeric, EachChannelThatNoHalfFloatCanHoldIsReplacedAlone) {
    EXPECT_EQ(storableColor(vec3(kQuietNan, 1.0f, 2.0f)), vec3(0.0f, 1.0f, 2.0f));
    EXPECT_EQ(storableColor(vec3(1.0f, kQuietNan, 2.0f)), vec3(1.0f, 0.0f, 2.0f));
    EXPECT_EQ(storableColor(vec3(1.0f, 2.0f, kQuietNan)), vec3(1.0f, 2.0f, 0.0f));
    EXPECT_EQ(
        storableColor(vec3(kPlusInfinity, -kPlusInfinity, -1.0f)), vec3(kMaxColor, 0.0f, 0.0f)
    );
    EXPECT_LT(kMaxColor, 65504.0f); // the largest half float
}

} // namespace
} // namespace shutter::shader
