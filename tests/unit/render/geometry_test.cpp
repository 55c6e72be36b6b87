// SPDX-License-Identifier: MIT
// Motion of points, ways of pixels packed into two words, rays at triangles, and numbers that are
// none.
#include "engine/math/math.h"
#include "shaders/common/numeric.glsl"
#include "shaders/common/pixel_way.glsl"
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
    EXPECT_LT(distance(screenFromClip(vec3(-5.0f, -5.0f, 5.0f), kPictureSize), vec2(0.0f)), 1e-4f);
    EXPECT_LT(distance(screenFromClip(vec3(5.0f), kPictureSize), kPictureSize), 1e-4f);
}

TEST(Motion, MotionPointsFromOpenToCloseInPixelsRightAndDown) {
    const vec3 open(0.0f, 0.0f, 2.0f);
    const vec3 close(0.2f, 0.4f, 2.0f); // a tenth and a fifth of clip space, halves of the picture
    const auto motionTo = [&](const vec3& from, const vec3& to) {
        return motionFromClip(from, to, to, 0.1f, kPictureSize);
    };
    EXPECT_LT(distance(motionTo(open, close), vec2(10.0f)), 1e-4f);
    EXPECT_LT(distance(motionTo(close, open), vec2(-10.0f)), 1e-4f);
    EXPECT_EQ(motionTo(close, close), vec2(0.0f));
}

TEST(Motion, OnlyAPointBehindIsPulledToWhereItsPathCrossesTheNearPlane) {
    const vec3 visible(4.0f, 2.0f, 3.0f);
    const vec3 behind(-4.0f, 6.0f, -1.0f);
    // w falls from 3 to -1; it is 1 half of the way.
    EXPECT_LT(distance(pullInFront(behind, visible, 1.0f), vec3(0.0f, 4.0f, 1.0f)), 1e-5f);
    const vec3 clip(1.0f, 2.0f, 0.1f);
    EXPECT_EQ(pullInFront(clip, vec3(0.0f, 0.0f, 3.0f), 0.1f), clip);
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

TEST(Motion, MotionIsClampedToTheStorableLengthAndNonFiniteMotionCountsAsStatic) {
    const vec3 near(0.0f, 0.0f, 1.0f);
    const vec3 far(3.0e6f, 4.0e6f, 1.0f);
    const vec2 motion = motionFromClip(near, far, near, 0.1f, vec2(100.0f));
    EXPECT_NEAR(length(motion), kMaxMotionPx, 1.0f);
    EXPECT_NEAR(motion.y / motion.x, 4.0f / 3.0f, 1e-4f);
    const vec3 clip(0.1f, 0.2f, 1.0f);
    for (const float bad : {kQuietNan, kPlusInfinity, -kPlusInfinity})
        for (const vec3& lost : {vec3(bad, 0.0f, 1.0f), vec3(0.0f, bad, 1.0f)}) {
            EXPECT_EQ(motionFromClip(lost, clip, clip, 0.1f, kPictureSize), vec2(0.0f));
            EXPECT_EQ(motionFromClip(clip, lost, clip, 0.1f, kPictureSize), vec2(0.0f));
        }
    const vec3 nowhere(0.0f, 0.0f, kQuietNan);
    EXPECT_EQ(motionFromClip(nowhere, clip, clip, 0.1f, kPictureSize), vec2(0.0f));
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

TEST(RayTriangle, TheSignOfTIsInFrontOrBehindAndDegenerateTrianglesAreNotHit) {
    const vec3 a(-1, -1, -2);
    const vec3 b(1, -1, -2);
    const vec3 c(0, 1, -2);
    const vec3 ahead(0, 0, -1);
    const TriangleHit front = intersectTriangle(vec3(0), 0.5f * ahead, a, b, c);
    EXPECT_TRUE(front.found);
    EXPECT_FLOAT_EQ(front.t, 4.0f);
    EXPECT_TRUE(front.frontFace);
    const TriangleHit behind = intersectTriangle(vec3(0), -ahead, a, b, c);
    EXPECT_TRUE(behind.found);
    EXPECT_FLOAT_EQ(behind.t, -2.0f);
    EXPECT_FALSE(behind.frontFace);
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, a, c, b).frontFace);
    for (const vec3& bad : {vec3(0), vec3(kQuietNan, 0, -1), vec3(0, 0, -kPlusInfinity)})
        EXPECT_FALSE(intersectTriangle(vec3(0), bad, a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(kQuietNan), ahead, a, b, c).found);
    for (const vec3& bad : {vec3(kQuietNan), vec3(0, kPlusInfinity, -2)})
        EXPECT_FALSE(intersectTriangle(vec3(0), ahead, a, b, bad).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, c, c, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0, -1, 0), ahead, a, b, b).found);
    // In the plane of the ray.
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, ahead, 2.0f * ahead, c).found);
}

TEST(Numeric, SaturateCutsBothEndsOffAndLuminanceIsRec709s) {
    EXPECT_EQ(saturate(-1.0f), 0.0f);
    EXPECT_EQ(saturate(0.25f), 0.25f);
    EXPECT_EQ(saturate(7.0f), 1.0f);
    EXPECT_EQ(saturate(kPlusInfinity), 1.0f);
    EXPECT_EQ(saturate(-kPlusInfinity), 0.0f);
    EXPECT_FLOAT_EQ(luminance(vec3(1.0f)), 1.0f);
    EXPECT_FLOAT_EQ(luminance(vec3(1.0f, 0.0f, 0.0f)), 0.2126f);
    EXPECT_FLOAT_EQ(luminance(vec3(0.0f, 2.0f, 0.0f)), 2.0f * 0.7152f);
    EXPECT_FLOAT_EQ(luminance(vec3(0.0f, 0.0f, 1.0f)), 0.0722f);
}

TEST(Numeric, NanAndInfinityAreNotFiniteAndOnlyNanIsNotANumber) {
    using Limits = std::numeric_limits<float>;
    for (const float x : {kQuietNan, -kQuietNan, kPlusInfinity, -kPlusInfinity})
        EXPECT_FALSE(isFinite(x));
    for (const float x : {0.0f, -3.4e38f, Limits::denorm_min(), Limits::max(), Limits::lowest()})
        EXPECT_TRUE(isFinite(x)) << x;
    // Quiet and signalling, of either sign, with the smallest and the largest payload.
    for (const uint bits : {0x7FC00000u, 0x7F800001u, 0x7FFFFFFFu, 0xFFC00000u, 0xFF800001u})
        EXPECT_TRUE(isNotANumber(uintBitsToFloat(bits))) << std::hex << bits;
    for (const float x : {0.0f, -0.0f, 1.0f, Limits::max(), kPlusInfinity})
        EXPECT_FALSE(isNotANumber(x) || isNotANumber(-x)) << x;
}

TEST(Numeric, OnlyChannelsThatNoHalfFloatCanHoldAreReplaced) {
    EXPECT_EQ(storableColor(vec3(0.0f, 0.5f, 64999.0f)), vec3(0.0f, 0.5f, 64999.0f));
    EXPECT_EQ(storableColor(vec3(kQuietNan, 1.0f, 2.0f)), vec3(0.0f, 1.0f, 2.0f));
    EXPECT_EQ(storableColor(vec3(1.0f, kQuietNan, 2.0f)), vec3(1.0f, 0.0f, 2.0f));
    EXPECT_EQ(storableColor(vec3(1.0f, 2.0f, kQuietNan)), vec3(1.0f, 2.0f, 0.0f));
    EXPECT_EQ(
        storableColor(vec3(kPlusInfinity, -kPlusInfinity, -1.0f)), vec3(kMaxColor, 0.0f, 0.0f)
    );
    EXPECT_LT(kMaxColor, 65504.0f); // the largest half float
}

float measureOff(const PixelWay& way) {
    const PixelWay back = unpackWay(packWay(way));
    float off = 0.0f;
    for (const vec2 gap : {back.open - way.open, back.close - way.close, back.bend - way.bend})
        off = std::max({off, std::abs(gap.x), std::abs(gap.y)});
    return off;
}

TEST(PixelWays, AWayIsPackedToA64thOfAPixelOrAShareOfItsLengthOrOfItsBend) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> share(-1.0f, 1.0f);
    const auto draw = [&](float most) { return most * vec2(share(random), share(random)); };
    for (const float longest : {1.0f, 15.0f, 31.0f, 100.0f, 1000.0f, 32768.0f})
        for (int i = 0; i < 200; ++i) {
            const PixelWay way{draw(longest), draw(longest), draw(longest / 16.0f)};
            EXPECT_LE(measureOff(way), std::max(1.0f / 64.0f, longest / 1000.0f)) << longest;
        }
    EXPECT_LE(measureOff({vec2(1.0f, -0.5f), vec2(0.0f), vec2(30.0f, -20.0f)}), 0.25f);
    EXPECT_EQ(measureOff({vec2(0.0f), vec2(0.0f), vec2(0.0f)}), 0.0f) << "to the bit";
    for (const float far : {1.0e3f, 1.0e6f, 1.0e20f, -1.0e3f, -1.0e6f, -1.0e20f})
        EXPECT_NE(packWay({vec2(far), vec2(far), vec2(far)}).x, kNoWay);
}

TEST(PixelWays, AWayGoesThroughItsEndsAndItsMiddleAndAStraightOneThroughTheRaster) {
    const PixelWay way{vec2(-8.0f, 2.0f), vec2(4.0f, 0.0f), vec2(1.0f, 3.0f)};
    EXPECT_EQ(displacementAt(way, 0.0f), way.open);
    EXPECT_EQ(displacementAt(way, 1.0f), way.close);
    EXPECT_EQ(displacementAt(way, 0.5f), vec2(-1.0f, 4.0f));
    const PixelWay straight = straightWay(vec2(12.0f, -4.0f), 0.25f);
    EXPECT_EQ(displacementAt(straight, 0.25f), vec2(0.0f));
    EXPECT_EQ(straight.close - straight.open, vec2(12.0f, -4.0f));
}

} // namespace
} // namespace shutter::shader
