// SPDX-License-Identifier: MIT
// Light on surfaces: reflection, sampling, and textures' detail.
#include "engine/math/math.h"
#include "shaders/common/sampling.glsl"
#include "shaders/render/brdf.glsl"
#include "shaders/render/split_samples_shared.h"
#include "shaders/render/texture_lod.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace shutter::shader {
namespace {

constexpr double kPiExact = 3.14159265358979323846;
constexpr vec3 kNormal{0.0f, 0.0f, 1.0f};

vec3 makeDirection(double cosine, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return vec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
}

/// The mean of what `sample` gives of places of the unit square: a share, and an angle around.
template <class Sample> double integrate(const Sample& sample) {
    constexpr int kSteps = 256;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j)
            sum += sample((i + 0.5) / kSteps, 2.0 * kPiExact * (j + 0.5) / kSteps);
    return sum / (kSteps * kSteps);
}

/// What a surface reflects towards `v` of light that comes with radiance 1 from everywhere: the
/// integral over half vectors, placed as GGX is (density D (n.h) / (4 (v.h))), so that the sharpest
/// highlight is no harder than the dullest.
double integrateByHalfVectors(vec3 baseColor, float metallic, float roughness, vec3 v) {
    const double alpha = double(roughness) * double(roughness);
    return integrate([&](double u, double angle) {
        const double cosine = std::sqrt((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u));
        const vec3 h = makeDirection(cosine, angle);
        const float vDotH = dot(v, h);
        const vec3 l = 2.0f * vDotH * h - v;
        if (vDotH <= 0.0f || l.z <= 0.0f)
            return 0.0;
        const double t = cosine * cosine * (alpha * alpha - 1.0) + 1.0;
        const double d = alpha * alpha / (kPiExact * t * t);
        const double density = d * cosine / (4.0 * double(vDotH));
        return double(reflectLight(baseColor, metallic, roughness, kNormal, v, l).x) / density;
    });
}

TEST(Brdf, TheMicrofacetsCoverTheSurfaceOnce) {
    // Integral of D (n.h) over the hemisphere.
    for (const float roughness : {0.3f, 0.5f, 1.0f}) {
        constexpr int kRings = 20000;
        double sum = 0.0;
        for (int i = 0; i < kRings; ++i) {
            const double cosine = (i + 0.5) / kRings;
            sum += double(distributionGgx(float(cosine), roughness * roughness)) * cosine;
        }
        EXPECT_NEAR(2.0 * kPiExact * sum / kRings, 1.0, 0.01) << roughness;
    }
}

TEST(Brdf, TheSharpestHighlightFitsIntoAHalfFloat) {
    const float peak = distributionGgx(1.0f, kMinRoughness * kMinRoughness);
    EXPECT_TRUE(isFinite(peak));
    EXPECT_LT(peak * visibilitySmith(1.0f, 1.0f, kMinRoughness * kMinRoughness), 65504.0f);
}

TEST(Brdf, VisibilityIsHeitzsHeightCorrelatedSmith) {
    for (const double alpha : {0.01, 0.25, 1.0})
        for (const double nDotL : {0.1, 0.5, 1.0})
            for (const double nDotV : {0.1, 0.7, 1.0}) {
                // G2 / (4 nl nv), G2 = 1 / (1 + lambda(v) + lambda(l)).
                const auto lambda = [&](double cosine) {
                    const double tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
                    return (std::sqrt(1.0 + alpha * alpha * tangent2) - 1.0) / 2.0;
                };
                const double expected =
                    1.0 / (1.0 + lambda(nDotL) + lambda(nDotV)) / (4.0 * nDotL * nDotV);
                const float v = visibilitySmith(float(nDotL), float(nDotV), float(alpha));
                EXPECT_NEAR(double(v), expected, 1e-4 * expected);
                EXPECT_FLOAT_EQ(v, visibilitySmith(float(nDotV), float(nDotL), float(alpha)));
            }
}

TEST(Brdf, FresnelIsF0StraightOnAndOneAtGrazing) {
    const vec3 f0(0.04f, 0.5f, 1.0f);
    EXPECT_EQ(fresnelSchlick(f0, 1.0f), f0);
    EXPECT_EQ(fresnelSchlick(f0, 0.0f), vec3(1.0f));
    EXPECT_NEAR(fresnelSchlick(f0, 0.5f).x, 0.04f + 0.96f / 32.0f, 1e-6f);
}

TEST(Brdf, AWhiteMetalNeverGivesBackMoreThanItGets) {
    for (const float roughness : {kMinRoughness, 0.1f, 0.3f, 0.6f, 1.0f})
        for (const double cosine : {1.0, 0.8, 0.4, 0.1}) {
            const double sum =
                integrateByHalfVectors(vec3(1.0f), 1.0f, roughness, makeDirection(cosine, 0.3));
            // A float's n.h resolves 6e-8, the sharpest lobe's width is 4e-6: 2 % of rounding
            // there.
            EXPECT_LE(sum, roughness == kMinRoughness ? 1.025 : 1.005)
                << roughness << " " << cosine;
            EXPECT_GT(sum, 0.3) << roughness << " " << cosine;
        }
}

TEST(Brdf, APolishedWhiteMetalLosesNearlyNothingAndABlackDielectricReflectsAtItsSurface) {
    EXPECT_NEAR(
        integrateByHalfVectors(vec3(1.0f), 1.0f, kMinRoughness, makeDirection(0.8, 0.0)), 1.0, 0.01
    );
    EXPECT_NEAR(
        integrateByHalfVectors(vec3(0.0f), 0.0f, 0.3f, makeDirection(1.0, 0.0)), 0.04, 0.005
    );
}

TEST(Brdf, AWhiteDielectricGivesBackNoMoreThanItGets) {
    for (const float roughness : {0.3f, 0.6f, 1.0f}) {
        constexpr int kViews = 16;
        double albedo = 0.0;
        for (int i = 0; i < kViews; ++i) {
            const double cosine = (i + 0.5) / kViews;
            const vec3 v = makeDirection(cosine, 0.3);
            // Over directions, placed by their cosine: there is no sharp highlight.
            const double sum =
                2.0 * kPiExact * integrate([&](double down, double angle) {
                    const vec3 l = makeDirection(down, angle);
                    return double(reflectLight(vec3(1.0f), 0.0f, roughness, kNormal, v, l).x);
                });
            albedo += 2.0 * cosine * sum / kViews;
            EXPECT_GT(sum, 0.7) << roughness << " " << cosine;
            // glTF's mix weighs Lambert by 1 - F(v.h), which hardly falls towards grazing views;
            // so that single views gain there (1.28 at a cosine of 0.1), though not the whole.
            if (cosine > 0.75) {
                EXPECT_LE(sum, 1.005) << roughness << " " << cosine;
            }
        }
        EXPECT_LE(albedo, 1.03) << roughness;
    }
}

TEST(Brdf, TheEnvironmentsShareIsNearTheIntegralItStandsFor) {
    for (const float roughness : {0.1f, 0.3f, 0.6f, 0.9f})
        for (const double cosine : {1.0, 0.7, 0.3}) {
            const vec3 share = environmentBrdf(vec3(1.0f), roughness, float(cosine));
            const double integral =
                integrateByHalfVectors(vec3(1.0f), 1.0f, roughness, makeDirection(cosine, 0.0));
            EXPECT_NEAR(double(share.x), integral, 0.16) << roughness << " " << cosine;
            EXPECT_LE(share.x, 1.01f);
            // For dielectrics the fit is close.
            const vec3 glass = environmentBrdf(vec3(0.04f), roughness, float(cosine));
            const double glassIntegral =
                integrateByHalfVectors(vec3(0.0f), 0.0f, roughness, makeDirection(cosine, 0.0));
            EXPECT_NEAR(double(glass.x), glassIntegral, 0.04) << roughness << " " << cosine;
            // The fit undershoots by 0.002 where nothing is reflected at all.
            EXPECT_GE(environmentBrdf(vec3(0.04f), roughness, float(cosine)).x, 0.0f);
            EXPECT_GE(environmentBrdf(vec3(0.0f), roughness, float(cosine)).x, -0.002f);
        }
}

TEST(Brdf, LightFromBelowTheSurfaceGivesNothingAndOfOppositeDirectionsAFiniteColour) {
    const vec3 v = makeDirection(0.7, 0.0);
    for (const vec3& below : {vec3(0.0f, 0.0f, -1.0f), vec3(1.0f, 0.0f, 0.0f)})
        EXPECT_EQ(reflectLight(vec3(1.0f), 0.0f, 0.5f, kNormal, v, below), vec3(0.0f));
    // The half vector vanishes where the light comes from behind a surface seen from its back.
    const vec3 l = makeDirection(0.6, 0.4);
    const vec3 color = reflectLight(vec3(0.5f), 0.3f, kMinRoughness, kNormal, -l, l);
    EXPECT_TRUE(isFinite(color.x) && isFinite(color.y) && isFinite(color.z));
}

TEST(Brdf, LightAndViewMayChangePlaces) {
    const vec3 v = makeDirection(0.9, 0.2);
    const vec3 l = makeDirection(0.3, 2.0);
    const vec3 one = reflectLight(vec3(0.8f), 0.2f, 0.4f, kNormal, v, l) / l.z;
    const vec3 other = reflectLight(vec3(0.8f), 0.2f, 0.4f, kNormal, l, v) / v.z;
    EXPECT_NEAR(one.x, other.x, 1e-5f);
}

TEST(ShutterTime, EveryAlignedRunOfAPowerOfTwoHasOneTimeAStratum) {
    for (const uint seed : {0u, 1u, 5u, 77u, 0xFFFFFFFFu})
        for (uint count = 1; count <= 1024; count *= 2)
            for (const uint first : {0u, count, 3u * count, 63u * count}) {
                std::set<uint> strata;
                for (uint i = first; i < first + count; ++i) {
                    const float s = shutterTime(i, seed);
                    ASSERT_TRUE(s >= 0.0f && s < 1.0f);
                    strata.insert(uint(s * float(count)));
                }
                EXPECT_EQ(strata.size(), count) << seed << " " << first;
            }
}

TEST(ShutterTime, EachRayAloneIsUniformOverTheExposureAndOverItsStratum) {
    // Whatever the ray: over many pixels its times cover the exposure, so that a picture of any
    // number of rays is not biased. 1024 pixels in 8 bins: 128 +- 10.6.
    for (const uint ray : {0u, 1u, 2u, 100u})
        for (const float strata : {1.0f, 16.0f}) {
            std::vector<int> bins(8, 0);
            for (uint y = 0; y < 32; ++y)
                for (uint x = 0; x < 32; ++x) {
                    const float s = strata * shutterTime(ray, hashPixel(uvec2(x, y), 3u, 0u));
                    ++bins[size_t((s - std::floor(s)) * 8.0f)];
                }
            for (const int count : bins)
                EXPECT_NEAR(count, 128, 53) << ray;
        }
}

TEST(ShutterTime, TwoSetsOfAPixelAreIndependent) {
    double covariance = 0.0;
    for (uint x = 0; x < 4096; ++x) {
        const double a = double(shutterTime(0u, hashPixel(uvec2(x, 7), 0u, 0u))) - 0.5;
        const double b = double(shutterTime(0u, hashPixel(uvec2(x, 7), 0u, 1u))) - 0.5;
        covariance += a * b / 4096.0;
    }
    // Standard deviation 1 / 12 / 64.
    EXPECT_NEAR(covariance, 0.0, 5.0 / 12.0 / 64.0);
}

TEST(SobolPoint, TheFirstPointsAreThePublishedOnesAndFurtherDimensionsAreStratified) {
    // Joe and Kuo 2008, "new-joe-kuo-6": eighths of the first three dimensions.
    const uvec3 expected[8] = {
        {0, 0, 0}, {4, 4, 4}, {2, 6, 6}, {6, 2, 2}, {1, 5, 3}, {5, 1, 7}, {3, 3, 5}, {7, 7, 1}};
    const uvec2 further[8] = {{0, 0}, {4, 4}, {6, 2}, {2, 6}, {1, 1}, {5, 5}, {7, 3}, {3, 7}};
    for (uint i = 0; i < 8; ++i) {
        EXPECT_EQ(sobolPoint(i) >> 29u, expected[i]) << i;
        EXPECT_EQ(sobolPoint45(i) >> 29u, further[i]) << i;
    }
}

TEST(LensPlace, PlacesCoverTheLensEvenlyAtAnyTimeAndPlaceInThePixel) {
    for (const uint seed : {1u, 900u})
        for (int other = 0; other < 3; ++other) {
            std::vector<int> cells(64, 0);
            for (uint i = 0; i < 4096; ++i) {
                const vec2 lens = lensPlace(i, seed);
                ASSERT_TRUE(lens.x >= 0.0f && lens.x < 1.0f && lens.y >= 0.0f && lens.y < 1.0f);
                const vec2 pixel = pixelPlace(i, seed);
                const float by = other == 0 ? shutterTime(i, seed) : other == 1 ? pixel.x : pixel.y;
                const auto cell = uvec3(uint(lens.x * 4.0f), uint(lens.y * 4.0f), uint(by * 4.0f));
                ++cells[(cell.x * 4 + cell.y) * 4 + cell.z];
            }
            EXPECT_EQ(cells, std::vector(64, 64)) << other;
        }
}

TEST(PixelPlace, PlaceAndTimeFillTheCubeEvenly) {
    // Elementary boxes of a net: whatever way the volume is cut into powers of two.
    for (const uint seed : {1u, 900u})
        for (int cut = 0; cut < 3; ++cut) {
            std::vector<int> cells(64, 0);
            for (uint i = 0; i < 256; ++i) {
                const vec2 place = pixelPlace(i, seed);
                ASSERT_TRUE(place.x >= 0.0f && place.x < 1.0f && place.y >= 0.0f && place.y < 1.0f);
                const float a = cut == 0 ? shutterTime(i, seed) : place.x;
                const float b = cut == 1 ? shutterTime(i, seed) : place.y;
                ++cells.at(size_t(a * 8.0f) * 8 + size_t(b * 8.0f));
            }
            EXPECT_EQ(cells, std::vector(64, 4)) << cut;
        }
}

TEST(HashPixel, NeighboursSeedsAndStreamsDiffer) {
    std::set<uint> found;
    for (uint x = 0; x < 16; ++x)
        for (uint y = 0; y < 16; ++y)
            for (uint seed = 0; seed < 4; ++seed)
                for (uint stream = 0; stream < 2; ++stream)
                    found.insert(hashPixel(uvec2(x, y), seed, stream));
    EXPECT_EQ(found.size(), 16u * 16u * 4u * 2u);
}

TEST(TextureLod, DensityIsTextureAreaOverSurfaceAreaByAnyTwoDisplacementsInThePlane) {
    // A square metre in 2 x 3 units of texture coordinates.
    const float density = textureDensity(
        vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f), vec2(2.0f, 0.0f), vec2(0.0f, 3.0f)
    );
    EXPECT_NEAR(density, 6.0f, 1e-5f);
    const vec3 edge1(1.0f, 0.2f, -0.3f);
    const vec3 edge2(0.1f, 2.0f, 0.7f);
    const vec2 uv1(0.4f, 0.1f);
    const vec2 uv2(-0.2f, 0.9f);
    const float expected = textureDensity(edge1, edge2, uv1, uv2);
    const float other = textureDensity(
        3.0f * edge1 - edge2, 0.5f * edge1 + 2.0f * edge2, 3.0f * uv1 - uv2, 0.5f * uv1 + 2.0f * uv2
    );
    EXPECT_NEAR(other, expected, 1e-5f * expected);
    const float none = textureDensity(vec3(1.0f), vec3(2.0f), vec2(0.0f, 1.0f), vec2(1.0f, 0.0f));
    EXPECT_TRUE(isFinite(none)) << "of no area";
    EXPECT_TRUE(isFinite(textureLevel(none, 1024.0f, 0.001f, 1.0f, 0.0f)));
    EXPECT_EQ(textureLevel(0.0f, 1024.0f, 0.001f, 1.0f, 0.0f), 0.0f);
}

TEST(TextureLod, ATexelAPixelIsLevelZeroAndEachDoublingOfDistanceOrBiasIsOneMore) {
    // Of 256 x 256 texels over one square metre.
    const auto levelOf = [](float footprint, float cosine, float bias) {
        return textureLevel(1.0f, 256.0f * 256.0f, footprint, cosine, bias);
    };
    for (int level = 0; level < 8; ++level)
        EXPECT_NEAR(levelOf(std::ldexp(1.0f / 256.0f, level), 1.0f, 0.0f), float(level), 1e-5f);
    EXPECT_EQ(levelOf(1.0e-6f, 1.0f, 0.0f), 0.0f) << "a nearer one is not magnified";
    EXPECT_EQ(levelOf(1.0f / 64.0f, 1.0f, -100.0f), 0.0f);
    EXPECT_NEAR(levelOf(1.0f / 16.0f, 0.25f, 0.0f), 5.0f, 1e-5f) << "a slanted one covers more";
    EXPECT_TRUE(isFinite(levelOf(1.0f / 16.0f, 0.0f, 0.0f))) << "edge on";
    EXPECT_NEAR(levelOf(1.0f / 32.0f, 1.0f, -1.5f), 1.5f, 1e-5f);
    EXPECT_NEAR(levelOf(1.0f / 32.0f, 1.0f, 0.5f), 3.5f, 1e-5f);
}

TEST(SamplesOfAPixel, ANormalIsPackedToATenthOfAMilliradian) {
    for (int i = 0; i < 2000; ++i) {
        // Over the sphere by the golden angle; the first few are the axes.
        const float z = 1.0f - (2.0f * float(i) + 1.0f) / 2000.0f;
        const float turn = 2.399963f * float(i);
        const float radius = std::sqrt(1.0f - z * z);
        vec3 normal(radius * std::cos(turn), radius * std::sin(turn), z);
        if (i < 6) {
            normal = vec3(0.0f);
            normal[i / 2] = i % 2 == 0 ? 1.0f : -1.0f;
        }
        EXPECT_LT(distance(unpackNormal(packNormal(normal)), normal), 1e-4f) << i;
    }
}

TEST(SamplesOfAPixel, RowsAreReadBackFromTheirWordsAndEachPlaceIsNearestToItself) {
    EXPECT_EQ(rowOfSample(kNoEntity), kNoEntity);
    EXPECT_EQ(rowOfSample(0u), 0u);
    EXPECT_EQ(rowOfSample(kSampleOfPart | 0x7Fu << kSampleRowBits | 0xFFFFFEu), 0xFFFFFEu);
    vec2 sum(0.0f);
    for (uint32_t i = 0; i < kSampleCount; ++i) {
        EXPECT_EQ(nearestSample(placeOfSample(i)), i);
        sum += placeOfSample(i);
    }
    EXPECT_EQ(sum, 0.5f * float(kSampleCount) * vec2(1.0f));
    EXPECT_EQ(nearestSample(vec2(0.5f)), 0u);
}

} // namespace
} // namespace shutter::shader
