// SPDX-License-Identifier: MIT
// Where shadow maps are looked up, and what their texels say.
#include "engine/extract/shadow_views.h"
#include "engine/math/math.h"
#include "shaders/render/shadow_filter.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace shutter::shader {

namespace {

constexpr uint kSize = 128;

ShadowPlace placeAt(const dmat4& clipFromWorld, const dvec3& point) {
    return placeInMap(vec4(clipFromWorld * dvec4(point, 1.0)), vec2(0.0f), kSize, 0.0f);
}

/// Depths of a plane at two places of a map, and what its slope at one says of the other.
/// \param light from where it comes: w 0 for a direction
void expectSlope(
    const extract::LightView& view,
    const dvec4& light,
    const dvec3& from,
    const dvec3& along,
    const dvec3& across
) {
    const dvec3 toLight = glm::normalize(dvec3(light) - light.w * from);
    dvec3 normal = glm::normalize(glm::cross(along, across));
    if (glm::dot(normal, toLight) < 0.0)
        normal = -normal;
    const vec2 slope = planeSlope(
        vec4(view.clipFromWorld * dvec4(from, 1.0)),
        vec4(view.clipFromWorld * dvec4(normal, 0.0)),
        float(glm::dot(normal, toLight)),
        float(view.texelMetres),
        kSize,
        view.isPerspective
    );
    const ShadowPlace here = placeAt(view.clipFromWorld, from);
    for (const dvec3& way : {along, across, along + across}) {
        const ShadowPlace there = placeAt(view.clipFromWorld, from + 0.3 * way);
        ASSERT_TRUE(there.isCovered);
        EXPECT_NEAR(here.depth + dot(slope, there.texel - here.texel), there.depth, 1e-5f);
    }
    EXPECT_GT(length(slope), 1e-6f);
}

/// A ball's, and that of a disc that lies level. Not constant: GLSL copies arrays, C++ does not.
vec4 ball[3] = {vec4(1, 0, 0, 0), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0)};
vec4 disc[3] = {vec4(1, 0, 0, 0), vec4(0, 2500, 0, 0), vec4(0, 0, 1, 0)};

} // namespace

TEST(ShadowFilter, WeightsSumToOneAndAreEvenAtTheCentre) {
    for (const float offset : {-0.5f, -0.2f, 0.0f, 0.31f, 0.5f}) {
        const vec3 weights = splineWeights(offset);
        EXPECT_NEAR(weights.x + weights.y + weights.z, 1.0f, 1e-6f);
    }
    EXPECT_EQ(splineWeights(0.0f).x, splineWeights(0.0f).z);
    // From texel to texel without a step.
    EXPECT_NEAR(splineWeights(0.5f).z, splineWeights(-0.5f).y, 1e-6f);
}

/// What filterMap() adds up where all nine texels let light through, or none does.
float addTexels(float right, float down, float caster) {
    const vec3 across = splineWeights(right);
    const vec3 rows = splineWeights(down);
    const float row = lightThrough(vec3(caster), across, vec3(0.5f));
    return rows.x * row + rows.y * row + rows.z * row;
}

TEST(ShadowFilter, WhatIsFullyLitOrDarkIsExactlySo) {
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

TEST(ShadowFilter, ASlopeIsExactOnAPlaneWhateverTheView) {
    const dvec3 toLight = glm::normalize(dvec3(0.3, 1.0, 0.2));
    const extract::LightView layer = extract::fitLayer(toLight, {{0, 0, 0}, 2.0}, kSize);
    const dvec3 from(0.1, 0.0, 0.2);
    expectSlope(layer, dvec4(toLight, 0.0), from, {1, 0, 0}, {0, 0, 1});
    expectSlope(layer, dvec4(toLight, 0.0), from, {1, 0.5, 0}, {0, 0.2, 1});
    const extract::LightView spot =
        extract::fitSpot({0, 5, 1}, glm::normalize(dvec3(0.1, -1, 0)), 0.7, 0.01, kSize);
    expectSlope(spot, {0, 5, 1, 1}, from, {1, 0.3, 0}, {0, 0.2, 1});
}

TEST(ShadowFilter, APlaneSeenFromItsEdgeHasNoSlope) {
    const extract::LightView layer = extract::fitLayer({0, 1, 0}, {{0, 0, 0}, 2.0}, kSize);
    for (const float cosine : {0.0f, -0.5f, std::numeric_limits<float>::quiet_NaN()}) {
        const vec2 slope = planeSlope(
            vec4(layer.clipFromWorld * dvec4(0, 0, 0, 1)),
            vec4(layer.clipFromWorld * dvec4(0, 0, 1, 0)),
            cosine,
            float(layer.texelMetres),
            kSize,
            false
        );
        EXPECT_EQ(slope, vec2(0.0f));
    }
}

TEST(ShadowFilter, EdgesAreMadeSharperWhereTexelsAreLargerThanPixelsAndStayWhereTheyAre) {
    EXPECT_EQ(sharpenEdge(0.5f, 0.1f), 0.5f);
    EXPECT_EQ(sharpenEdge(0.3f, 4.0f), 0.3f) << "texels are smaller than pixels";
    EXPECT_NEAR(sharpenEdge(0.4f, 0.1f), 0.5f - 0.1f * kMostEdgeContrast, 1e-6f);
    for (const float texels : {0.0f, 0.1f, 1.0f, 10.0f}) {
        EXPECT_EQ(sharpenEdge(0.0f, texels), 0.0f);
        EXPECT_EQ(sharpenEdge(1.0f, texels), 1.0f);
    }
}

TEST(ShadowFilter, PlacesOutsideOfAMapAreNotCovered) {
    EXPECT_TRUE(placeInMap(vec4(0, 0, 0.5f, 1), vec2(0), kSize, 0.0f).isCovered);
    EXPECT_FALSE(placeInMap(vec4(0.999f, 0, 0.5f, 1), vec2(0), kSize, 0.0f).isCovered);
    EXPECT_FALSE(placeInMap(vec4(0, -0.999f, 0.5f, 1), vec2(0), kSize, 0.0f).isCovered);
    EXPECT_FALSE(placeInMap(vec4(0, 0, 0.5f, -1), vec2(0), kSize, 0.0f).isCovered);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(placeInMap(vec4(nan, 0, 0.5f, 1), vec2(0), kSize, 0.0f).isCovered);
}

TEST(ShadowFilter, EmptyTexelsHoldNoLightBackEvenBehindTheMapsReach) {
    const vec3 weights = splineWeights(0.1f);
    EXPECT_FLOAT_EQ(lightThrough(vec3(0.0f), weights, vec3(-0.5f)), 1.0f);
    EXPECT_FLOAT_EQ(lightThrough(vec3(0.2f), weights, vec3(-0.5f)), 0.0f);
    EXPECT_FLOAT_EQ(lightThrough(vec3(0.2f, 0.6f, 0.2f), weights, vec3(0.4f)), 1.0f - weights.y);
}

TEST(ShadowFilter, AMoverThatOnlyWentElsewhereKeepsItsRay) {
    const vec3 light = normalize(vec3(0.2f, 1.0f, 0.1f));
    const vec3 point(1.0f, -2.0f, 0.5f);
    const vec3 aligned = alignRay(point, light, light, vec3(0.3f, 1.0f, 0.0f), ball);
    EXPECT_NEAR(length(aligned - point), 0.0f, 1e-5f);
    const vec4 byPoint =
        alignPointRay(point, vec3(0, 5, 0), vec3(0, 5, 0), vec3(0.3f, 1.0f, 0.0f), disc);
    EXPECT_EQ(byPoint.w, 1.0f);
    EXPECT_NEAR(length(vec3(byPoint) - point), 0.0f, 1e-5f);
}

TEST(ShadowFilter, ATurnKeepsWhereTheRayPassesTheMoversMiddle) {
    const vec3 light(0.0f, 1.0f, 0.0f);
    const vec3 turned = normalize(vec3(0.1f, 1.0f, 0.0f));
    const vec3 centre(0.0f);
    // Through the middle, from far below.
    const vec3 aligned = alignRay(-8.0f * turned, turned, light, centre, ball);
    EXPECT_NEAR(aligned.x, 0.0f, 1e-5f);
    EXPECT_NEAR(aligned.y, -8.0f, 1e-4f);
}

TEST(ShadowFilter, OfWhatIsFlatATurnKeepsWhereTheRayPassesThePlane) {
    // The disc has turned under the light; the ray passes it off its middle.
    const vec3 light(0.0f, 1.0f, 0.0f);
    const vec3 turned = normalize(vec3(0.8f, 1.0f, 0.3f));
    const vec3 passed(0.7f, 0.0f, -0.4f);
    const vec3 aligned = alignRay(passed - 5.0f * turned, turned, light, vec3(0.0f), disc);
    EXPECT_NEAR(aligned.x, passed.x, 2e-3f);
    EXPECT_NEAR(aligned.z, passed.z, 2e-3f);
    const vec3 lamp(0.2f, 4.0f, 0.1f);
    const vec3 seen(-1.0f, 3.5f, 0.4f);
    const vec3 receiver = seen + 1.6f * (passed - seen);
    const vec4 byPoint = alignPointRay(receiver, seen, lamp, vec3(0.0f), disc);
    ASSERT_EQ(byPoint.w, 1.0f);
    // Where the ray from the lamp through the aligned point is level with the disc.
    const vec3 aligned2(byPoint);
    const float share = lamp.y / (lamp.y - aligned2.y);
    const vec3 met = lamp + (aligned2 - lamp) * share;
    EXPECT_NEAR(met.x, passed.x, 5e-3f);
    EXPECT_NEAR(met.z, passed.z, 5e-3f);
}

TEST(ShadowFilter, WhatIsBehindAPointLightIsNotLookedUp) {
    EXPECT_EQ(alignPointRay(vec3(0, 7, 0), vec3(0, 5, 0), vec3(0, 5, 0), vec3(0), ball).w, 0.0f);
}

TEST(ShadowFilter, ARayMeetsSpheresBetweenItsEndsAlone) {
    const vec4 sphere(0.0f, 3.0f, 0.0f, 1.0f);
    EXPECT_TRUE(meetsSphere(vec3(0.9f, 0, 0), vec3(0, 1, 0), 10.0f, sphere));
    EXPECT_FALSE(meetsSphere(vec3(1.1f, 0, 0), vec3(0, 1, 0), 10.0f, sphere));
    EXPECT_FALSE(meetsSphere(vec3(0), vec3(0, 1, 0), 1.5f, sphere)) << "the light is before it";
    EXPECT_FALSE(meetsSphere(vec3(0, 5, 0), vec3(0, 1, 0), 10.0f, sphere)) << "it lies behind";
    EXPECT_TRUE(meetsSphere(vec3(0, 3, 0), vec3(0, 1, 0), 10.0f, sphere)) << "from inside";
}

} // namespace shutter::shader
