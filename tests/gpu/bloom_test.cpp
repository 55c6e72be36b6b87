// SPDX-License-Identifier: MIT
// Bloom spreads light and keeps it.
#include "modules/bloom/bloom.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <cmath>
#include <limits>

namespace shutter {
namespace {

class Bloom : public test::GpuTest {
  protected:
    /// \param isHalf the picture is of half floats, as frames are; false: of floats, as sums are
    image::Image run(const image::Image& picture, float share, bool isHalf = true) {
        test::GraphRig rig(device());
        const graph::ImageHandle color = isHalf ? rig.uploadColor(picture) : rig.upload(picture);
        test::EffectRig effect(rig, color, picture.width, picture.height);
        bloom::Bloom bloom(device(), {share});
        EXPECT_TRUE(bloom.ask(effect.facts).run);
        bloom.declare(effect.context);
        const size_t ticket = rig.want(effect.context.color);
        test::run(rig);
        return rig.take(ticket);
    }

    static double sum(const image::Image& picture) {
        double all = 0.0;
        for (uint32_t y = 0; y < picture.height; ++y)
            for (uint32_t x = 0; x < picture.width; ++x)
                all += picture.at(x, y, 0);
        return all;
    }

    /// Black, with one pixel of light.
    static image::Image makePoint(uint32_t width, uint32_t height, uint32_t x, uint32_t y) {
        image::Image picture = test::makePicture(width, height, 0.0f);
        for (uint32_t c = 0; c < 4; ++c)
            picture.at(x, y, c) = 1000.0f;
        return picture;
    }
};

TEST_F(Bloom, WhatIsEvenStaysAsItIs) {
    for (const auto size : {glm::uvec2(64, 48), glm::uvec2(131, 37), glm::uvec2(8, 200)}) {
        const image::Image bloomed = run(test::makePicture(size.x, size.y, 0.75f), 0.3f);
        for (const float value : bloomed.pixels)
            ASSERT_NEAR(value, 0.75f, 1e-3f);
    }
}

TEST_F(Bloom, APointOfLightSpreadsAndKeepsItsLight) {
    // Wherever it lies in the coarser images' pixels, and at sizes that do not halve evenly.
    for (const auto size : {glm::uvec2(256, 256), glm::uvec2(251, 233)})
        for (uint32_t x = 120; x < 128; x += 3) {
            const image::Image point = makePoint(size.x, size.y, x, 117);
            const image::Image bloomed = run(point, 0.5f);
            EXPECT_NEAR(bloomed.at(x, 117, 0), 500.0, 60.0);
            EXPECT_GT(bloomed.at(x + 12, 117, 0), 0.0f);
            EXPECT_NEAR(sum(bloomed), 1000.0, 10.0) << size.x << ", " << x;
        }
}

TEST_F(Bloom, LightSpreadsAlikeInAllDirections) {
    // Between the two middle pixels nothing is the middle: each has a mirror image.
    image::Image points = makePoint(128, 128, 63, 63);
    for (const auto at : {glm::uvec2(64, 63), glm::uvec2(63, 64), glm::uvec2(64, 64)})
        for (uint32_t c = 0; c < 4; ++c)
            points.at(at.x, at.y, c) = 1000.0f;
    const image::Image bloomed = run(points, 0.2f);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x) {
            const float value = bloomed.at(x, y, 0);
            const float tolerance = 2e-3f * value + 1e-4f;
            ASSERT_NEAR(bloomed.at(127 - x, y, 0), value, tolerance) << x << ", " << y;
            ASSERT_NEAR(bloomed.at(y, x, 0), value, tolerance) << x << ", " << y;
        }
}

TEST_F(Bloom, ItReachesTheSameShareOfThePictureAtEachResolution) {
    const image::Image small = run(makePoint(128, 128, 64, 64), 0.5f);
    image::Image same = makePoint(256, 256, 128, 128); // the same light at twice the resolution
    for (const auto at : {glm::uvec2(129, 128), glm::uvec2(128, 129), glm::uvec2(129, 129)})
        for (uint32_t c = 0; c < 4; ++c)
            same.at(at.x, at.y, c) = 1000.0f;
    const image::Image large = run(same, 0.5f);
    for (const uint32_t away : {8u, 16u, 32u}) {
        const float expected = small.at(64 + away, 64, 0);
        EXPECT_NEAR(large.at(128 + 2 * away, 128, 0), expected, 0.25f * expected) << away;
    }
}

TEST_F(Bloom, SumsOfFloatsAreFilteredAlike) {
    const image::Image noise = test::makeNoise(123, 77);
    const image::Image half = run(noise, 0.4f);
    const image::Image whole = run(noise, 0.4f, false);
    for (size_t i = 0; i < half.pixels.size(); ++i)
        ASSERT_NEAR(half.pixels[i], whole.pixels[i], 4e-3f) << i;
}

TEST_F(Bloom, TheBrightestLightStaysFinite) {
    EXPECT_TRUE(test::allFinite(run(test::makePicture(96, 64, 65000.0f), 1.0f)));
}

TEST_F(Bloom, ItIsSkippedWithoutLightToScatterAndInTinyPictures) {
    render::ViewFacts facts;
    facts.width = 640;
    facts.height = 360;
    EXPECT_FALSE(bloom::Bloom(device(), {0.0f}).ask(facts).run);
    EXPECT_TRUE(bloom::Bloom(device(), {0.1f}).ask(facts).run);
    facts.height = 7;
    EXPECT_FALSE(bloom::Bloom(device(), {0.1f}).ask(facts).run);
    EXPECT_EQ(bloom::countLevels(7, 640), 0u);
    EXPECT_EQ(bloom::countLevels(8, 640), 1u);
    EXPECT_EQ(bloom::countLevels(1920, 1080), 8u);
    EXPECT_EQ(bloom::countLevels(65536, 65536), 10u);
}

TEST_F(Bloom, SharesOutsideTheirRangeAreRefused) {
    for (const float share : {-0.1f, 1.1f, std::numeric_limits<float>::quiet_NaN()})
        EXPECT_FALSE(bloom::validate({share}).ok()) << share;
    EXPECT_TRUE(bloom::validate({1.0f}).ok());
}

} // namespace
} // namespace shutter
