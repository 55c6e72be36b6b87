// SPDX-License-Identifier: MIT
#include "shaders/render/texture_lod.glsl"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::shader {

TEST(TextureLod, DensityIsTextureAreaOverSurfaceArea) {
    // A square metre in 2 x 3 units of texture coordinates.
    const float density = textureDensity(
        vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f), vec2(2.0f, 0.0f), vec2(0.0f, 3.0f)
    );
    EXPECT_NEAR(density, 6.0f, 1e-5f);
}

TEST(TextureLod, AnyTwoDisplacementsInThePlaneGiveTheSameDensity) {
    const vec3 edge1(1.0f, 0.2f, -0.3f);
    const vec3 edge2(0.1f, 2.0f, 0.7f);
    const vec2 uv1(0.4f, 0.1f);
    const vec2 uv2(-0.2f, 0.9f);
    const float expected = textureDensity(edge1, edge2, uv1, uv2);
    const float other = textureDensity(
        3.0f * edge1 - edge2, 0.5f * edge1 + 2.0f * edge2, 3.0f * uv1 - uv2, 0.5f * uv1 + 2.0f * uv2
    );
    EXPECT_NEAR(other, expected, 1e-5f * expected);
}

TEST(TextureLod, ATriangleWithoutAreaHasAFiniteLevel) {
    const float density =
        textureDensity(vec3(1.0f), vec3(2.0f), vec2(0.0f, 1.0f), vec2(1.0f, 0.0f));
    EXPECT_TRUE(isFinite(density));
    EXPECT_TRUE(isFinite(textureLevel(density, 1024.0f, 0.001f, 1.0f, 0.0f)));
    EXPECT_EQ(textureLevel(0.0f, 1024.0f, 0.001f, 1.0f, 0.0f), 0.0f);
}

TEST(TextureLod, ATexelAPixelIsLevelZeroAndEachDoublingOfDistanceIsOneMore) {
    constexpr float kTexels = 256.0f * 256.0f; // over one square metre
    for (int level = 0; level < 8; ++level) {
        const float footprint = std::ldexp(1.0f / 256.0f, level);
        EXPECT_NEAR(
            textureLevel(1.0f, kTexels, footprint, 1.0f, 0.0f), static_cast<float>(level), 1e-5f
        );
    }
}

TEST(TextureLod, ANearerSurfaceIsNotMagnifiedBelowLevelZero) {
    EXPECT_EQ(textureLevel(1.0f, 256.0f * 256.0f, 1.0e-6f, 1.0f, 0.0f), 0.0f);
    EXPECT_EQ(textureLevel(1.0f, 256.0f * 256.0f, 1.0f / 64.0f, 1.0f, -100.0f), 0.0f);
}

TEST(TextureLod, ASlantedSurfaceCoversMoreOfTheTexture) {
    constexpr float kTexels = 256.0f * 256.0f;
    const float straight = textureLevel(1.0f, kTexels, 1.0f / 16.0f, 1.0f, 0.0f);
    EXPECT_NEAR(textureLevel(1.0f, kTexels, 1.0f / 16.0f, 0.25f, 0.0f), straight + 1.0f, 1e-5f);
    // Edge on: bounded, not infinite.
    EXPECT_TRUE(isFinite(textureLevel(1.0f, kTexels, 1.0f / 16.0f, 0.0f, 0.0f)));
}

TEST(TextureLod, TheBiasIsAdded) {
    constexpr float kTexels = 256.0f * 256.0f;
    EXPECT_NEAR(textureLevel(1.0f, kTexels, 1.0f / 32.0f, 1.0f, -1.5f), 1.5f, 1e-5f);
    EXPECT_NEAR(textureLevel(1.0f, kTexels, 1.0f / 32.0f, 1.0f, 0.5f), 3.5f, 1e-5f);
}

} // namespace shutter::shader
