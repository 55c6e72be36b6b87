// SPDX-License-Identifier: MIT
// The filters of shadow maps, on views that the engine fits (so not among the tests of
// tests/erring, which link no library).
#include "engine/math/math.h"
#include "modules/shadows/shadow_views.h"
#include "shaders/shadows/shadow_filter.glsl"

#include <gtest/gtest.h>

#include <limits>

namespace shutter::shader {
namespace {

constexpr uint kSize = 128;

/// 16 metres wide and deep, its corner at (-6, -5) metres, its farthest depth at -4.
ShadowCascade makeCascade() {
    ShadowCascade cascade{};
    cascade.texelsPerMetre = kSize / 16.0f;
    cascade.corner = vec2(6.0f, 5.0f) * cascade.texelsPerMetre;
    cascade.depthPerMetre = 1.0f / 16.0f;
    cascade.depth = 4.0f / 16.0f;
    cascade.sizePx = kSize;
    return cascade;
}

/// A ball's, and that of a disc that lies level. Not constant: GLSL copies arrays, C++ does not.
vec4 ball[3] = {vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)};
vec4 disc[3] = {vec4(1, 0, 0, 0), vec4(0, 2500, 0, 0), vec4(0, 0, 1, 0)};

TEST(ShadowFilter, WeightsSumToOneAndEdgesAreSharperWhereTexelsAreLargerThanPixels) {
    for (const float offset : {-0.5f, -0.2f, 0.0f, 0.31f, 0.5f}) {
        const vec3 weights = splineWeights(offset);
        EXPECT_NEAR(weights.x + weights.y + weights.z, 1.0f, 1e-6f);
    }
    EXPECT_EQ(splineWeights(0.0f).x, splineWeights(0.0f).z);
    // From texel to texel without a step.
    EXPECT_NEAR(splineWeights(0.5f).z, splineWeights(-0.5f).y, 1e-6f);
    EXPECT_EQ(sharpenEdge(0.5f, 0.1f), 0.5f);
    EXPECT_EQ(sharpenEdge(0.3f, 4.0f), 0.3f) << "texels are smaller than pixels";
    EXPECT_NEAR(sharpenEdge(0.4f, 0.1f), 0.5f - 0.1f * kMaxEdgeContrast, 1e-6f);
    for (const float texels : {0.0f, 0.1f, 1.0f, 10.0f}) {
        EXPECT_EQ(sharpenEdge(0.0f, texels), 0.0f);
        EXPECT_EQ(sharpenEdge(1.0f, texels), 1.0f);
    }
}

/// The sum of filterMap() if all nine texels transmit light, or none does.
float addTexels(float right, float down, float caster) {
    const vec3 across = splineWeights(right);
    const vec3 rows = splineWeights(down);
    const float row = lightThrough(vec3(caster), across, vec3(0.5f));
    return rows.x * row + rows.y * row + rows.z * row;
}

TEST(ShadowFilter, FullyLitAndDarkPointsAreExact) {
    bool isRounded = false;
    for (int i = -50; i <= 50; ++i)
        for (int j = -50; j <= 50; ++j) {
            const float lit = addTexels(0.01f * float(i), 0.01f * float(j), 0.0f);
            isRounded = isRounded || lit != 1.0f;
            EXPECT_EQ(settleLight(lit), 1.0f) << i << ", " << j;
            EXPECT_EQ(settleLight(1.0f - lit), 0.0f) << i << ", " << j;
        }
    EXPECT_TRUE(isRounded) << "nothing had to be settled";
    for (const float soft : {1.0e-3f, 0.25f, 0.999f})
        EXPECT_EQ(settleLight(soft), soft);
}

TEST(ShadowFilter, ASlopePredictsTheDepthsOfAPlaneInASpotsMap) {
    const dvec3 light(0, 5, 1);
    const dvec3 from(0.1, 0.0, 0.2);
    const dvec3 along(1, 0.3, 0);
    const dvec3 across(0, 0.2, 1);
    const shadows::LightView view =
        shadows::fitSpot(light, glm::normalize(dvec3(0.1, -1, 0)), 0.7, 0.01, kSize);
    const dvec3 normal = glm::normalize(glm::cross(across, along));
    const vec2 slope = planeSlope(
        vec4(view.clipFromWorld * dvec4(from, 1.0)),
        vec4(view.clipFromWorld * dvec4(normal, 0.0)),
        float(glm::dot(normal, glm::normalize(light - from))),
        float(view.texelMetres),
        kSize
    );
    const auto placeAt = [&](const dvec3& point) {
        return placeInMap(vec4(view.clipFromWorld * dvec4(point, 1.0)), vec2(0.0f), kSize);
    };
    const ShadowPlace here = placeAt(from);
    for (const dvec3& way : {along, across, along + across}) {
        const ShadowPlace there = placeAt(from + 0.3 * way);
        ASSERT_TRUE(there.isCovered);
        EXPECT_NEAR(here.depth + dot(slope, there.texel - here.texel), there.depth, 1e-5f);
    }
    EXPECT_GT(length(slope), 1e-6f);
}

TEST(ShadowFilter, ASlopeIsExactInACascade) {
    const ShadowCascade cascade = makeCascade();
    const vec3 normal = normalize(vec3(0.5f, -0.3f, 1.0f));
    const vec3 across = normalize(cross(normal, vec3(0, 1, 0)));
    const vec3 from(1.0f, 2.0f, 0.5f);
    const ShadowPlace here = placeInCascade(cascade, from, normal);
    for (const vec3& way : {across, cross(normal, across)}) {
        const ShadowPlace there = placeInCascade(cascade, from + 2.0f * way, normal);
        EXPECT_GT(length(there.texel - here.texel), 5.0f);
        EXPECT_NEAR(here.depth + dot(here.slope, there.texel - here.texel), there.depth, 1e-5f);
    }
    EXPECT_GT(length(here.slope), 1e-3f);
    EXPECT_EQ(placeInCascade(cascade, from, vec3(1, 0, 0)).slope, vec2(0.0f)) << "from its edge";
}

TEST(ShadowFilter, AReceiverIsLiftedOffItsSurfaceTowardsItsNormal) {
    const ShadowCascade cascade = makeCascade();
    const vec3 point(1.0f, 2.0f, 0.5f);
    const ShadowPlace level = placeInCascade(cascade, point, vec3(0, 0, 1));
    EXPECT_EQ(level.texel, findTexel(cascade, point));
    EXPECT_GT(level.depth, point.z * cascade.depthPerMetre + cascade.depth);
    const ShadowPlace steep = placeInCascade(cascade, point, normalize(vec3(1, 0, 0.5f)));
    EXPECT_GT(steep.texel.x, level.texel.x + 0.2f);
}

TEST(ShadowFilter, ACascadeThatHasAPointHasItLiftedToo) {
    const ShadowCascade cascade = makeCascade();
    size_t had = 0;
    for (int i = 0; i < 4000; ++i) {
        const vec3 point(-6.0f + 0.004f * float(i), -1.0f, 0.0f);
        if (!hasPoint(cascade, point))
            continue;
        ++had;
        for (const float x : {-0.999f, 0.999f}) {
            const vec3 normal(x, 0.0f, sqrt(1.0f - x * x));
            const ShadowPlace place = placeInCascade(cascade, point, normal);
            ASSERT_TRUE(coversFilter(place.texel, float(kSize))) << point.x;
        }
    }
    EXPECT_GT(had, 3600u);
    EXPECT_FALSE(hasPoint(cascade, vec3(std::numeric_limits<float>::quiet_NaN())));
}

TEST(ShadowFilter, APlaneSeenFromItsEdgeHasNoSlope) {
    const shadows::LightView spot = shadows::fitSpot({0, 5, 0}, {0, -1, 0}, 0.7, 0.01, kSize);
    // Not constant: GLSL copies arrays, C++ does not.
    vec4 run[2] = {vec4(1.0f), vec4(2.0f)};
    for (const float cosine : {0.0f, -0.5f, std::numeric_limits<float>::quiet_NaN()}) {
        const vec2 slope = planeSlope(
            vec4(spot.clipFromWorld * dvec4(0, 0, 0, 1)),
            vec4(spot.clipFromWorld * dvec4(0, 0, 1, 0)),
            cosine,
            float(spot.texelMetres),
            kSize
        );
        EXPECT_EQ(slope, vec2(0.0f));
        EXPECT_EQ(planeSlopeOnRun(run, vec3(0, 1, 0), cosine), vec2(0.0f));
    }
}

TEST(ShadowFilter, PlacesOutsideOfAMapAreNotCovered) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(placeInMap(vec4(0, 0, 0.5f, 1), vec2(0), kSize).isCovered);
    for (const vec4& outside :
         {vec4(0.999f, 0, 0.5f, 1),
          vec4(0, -0.999f, 0.5f, 1),
          vec4(0, 0, 0.5f, -1),
          vec4(nan, 0, 0.5f, 1)})
        EXPECT_FALSE(placeInMap(outside, vec2(0), kSize).isCovered);
}

TEST(ShadowFilter, EmptyTexelsHoldNoLightBackEvenBehindTheMapsReach) {
    const vec3 weights = splineWeights(0.1f);
    EXPECT_FLOAT_EQ(lightThrough(vec3(0.0f), weights, vec3(-0.5f)), 1.0f);
    EXPECT_FLOAT_EQ(lightThrough(vec3(0.2f), weights, vec3(-0.5f)), 0.0f);
    EXPECT_FLOAT_EQ(lightThrough(vec3(0.2f, 0.6f, 0.2f), weights, vec3(0.4f)), 1.0f - weights.y);
}

TEST(ShadowFilter, AMoverThatOnlyWentElsewhereKeepsItsRayAndNoneIsOfReceiversBehindTheLight) {
    const vec3 point(1.0f, -2.0f, 0.5f);
    const vec3 lamp(0, 5, 0);
    const vec4 aligned = alignPointRay(point, lamp, lamp, vec3(0.3f, 1.0f, 0.0f), disc);
    EXPECT_EQ(aligned.w, 1.0f);
    EXPECT_NEAR(length(vec3(aligned) - point), 0.0f, 1e-5f);
    EXPECT_EQ(alignPointRay(vec3(0, 7, 0), lamp, lamp, vec3(0), ball).w, 0.0f);
}

TEST(ShadowFilter, RotationOfAFlatMoverPreservesTheRaysPlanePoint) {
    // The disc has turned under the lamp; the ray passes it off its middle.
    const vec3 passed(0.7f, 0.0f, -0.4f);
    const vec3 lamp(0.2f, 4.0f, 0.1f);
    const vec3 seen(-1.0f, 3.5f, 0.4f);
    const vec3 receiver = seen + 1.6f * (passed - seen);
    const vec4 byPoint = alignPointRay(receiver, seen, lamp, vec3(0.0f), disc);
    ASSERT_EQ(byPoint.w, 1.0f);
    // Where the ray from the lamp through the aligned point is level with the disc.
    const vec3 aligned(byPoint);
    const float share = lamp.y / (lamp.y - aligned.y);
    const vec3 met = lamp + (aligned - lamp) * share;
    EXPECT_NEAR(met.x, passed.x, 5e-3f);
    EXPECT_NEAR(met.z, passed.z, 5e-3f);
}

TEST(ShadowFilter, ARayMeetsSpheresBetweenItsEndsAlone) {
    const vec4 sphere(0.0f, 3.0f, 0.0f, 1.0f);
    EXPECT_TRUE(meetsSphere(vec3(0.9f, 0, 0), vec3(0, 1, 0), 10.0f, sphere));
    EXPECT_FALSE(meetsSphere(vec3(1.1f, 0, 0), vec3(0, 1, 0), 10.0f, sphere));
    EXPECT_FALSE(meetsSphere(vec3(0), vec3(0, 1, 0), 1.5f, sphere)) << "the light is before it";
    EXPECT_FALSE(meetsSphere(vec3(0, 5, 0), vec3(0, 1, 0), 10.0f, sphere)) << "it lies behind";
    EXPECT_TRUE(meetsSphere(vec3(0, 3, 0), vec3(0, 1, 0), 10.0f, sphere)) << "from inside";
}

} // namespace
} // namespace shutter::shader
