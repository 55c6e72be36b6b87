// SPDX-License-Identifier: MIT
// Bloom spreads light and keeps it.
#include "modules/bloom/bloom.h"
#include "shaders/bloom/bloom.glsl"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <cmath>
#include <limits>
#include <string>

namespace shutter {
namespace {

class Bloom : public test::GpuTest {
  protected:
    /// All light scatters. \param isHalf the picture is of half floats, as frames are; false: of
    /// floats, as sums are
    image::Image run(const image::Image& picture, float share, bool isHalf = true) {
        return run(picture, {.share = share, .threshold = 0.0f}, isHalf);
    }

    image::Image
    run(const image::Image& picture, const bloom::BloomSettings& settings, bool isHalf = true) {
        test::GraphRig rig(device());
        const graph::ImageHandle color = isHalf ? rig.uploadColor(picture) : rig.upload(picture);
        test::EffectRig effect(rig, color, picture.width, picture.height);
        bloom::Bloom bloom(device(), settings);
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

TEST_F(Bloom, WhatIsBelowTheKneeStaysAsItIs) {
    image::Image noise = test::makeNoise(123, 77);
    for (float& value : noise.pixels)
        value = image::roundToHalf(0.25f + 0.25f * value); // the knee begins at 0.5
    const image::Image bloomed = run(noise, {.share = 0.8f, .threshold = 1.0f, .knee = 0.5f});
    for (size_t i = 0; i < noise.pixels.size(); ++i)
        ASSERT_EQ(bloomed.pixels[i], noise.pixels[i]) << i;
}

TEST_F(Bloom, OnlyLightAboveTheThresholdSpreadsAndTheWholeIsKept) {
    image::Image point = makePoint(256, 256, 120, 117);
    for (float& value : point.pixels)
        value += 0.25f; // around the light, below the knee
    const double before = sum(point);
    const image::Image bloomed = run(point, {.share = 0.5f, .threshold = 400.0f, .knee = 0.25f});
    EXPECT_NEAR(bloomed.at(120, 117, 0), 1000.0 - 0.5 * 600.0, 40.0);
    EXPECT_GT(bloomed.at(132, 117, 0), 0.251f);
    EXPECT_NEAR(sum(bloomed), before, 10.0);
}

TEST_F(Bloom, AMeanThatIsBelowTheThresholdDoesNotHideAHighlight) {
    // One bright texel among dark ones: the four of a corner are 3 on average.
    const image::Image point = makePoint(64, 64, 31, 31);
    image::Image dim = point;
    for (float& value : dim.pixels)
        value *= 12.0f / 1000.0f;
    const image::Image bloomed = run(dim, {.share = 0.5f, .threshold = 8.0f, .knee = 0.0f});
    EXPECT_NEAR(bloomed.at(31, 31, 0), 10.0, 0.3);
    EXPECT_NEAR(sum(bloomed), 12.0, 0.2);
}

TEST_F(Bloom, ItRunsWhereTheLastPictureHadAHighlightOrIsNotKnown) {
    const bloom::BloomSettings settings{.share = 0.1f, .threshold = 2.0f, .knee = 0.25f};
    const bloom::Bloom bloom(device(), settings);
    EXPECT_EQ(bloom::findKneeStart(settings), 1.5f);
    render::ViewFacts facts;
    facts.width = 640;
    facts.height = 360;
    EXPECT_TRUE(bloom.ask(facts).run);
    facts.lastBrightest = 1.51f;
    EXPECT_TRUE(bloom.ask(facts).run);
    facts.lastBrightest = 1.5f;
    EXPECT_FALSE(bloom.ask(facts).run);
    EXPECT_NE(bloom.ask(facts).reason.find("knee"), std::string::npos);
    // Without a threshold all light is scattered; in the dark there is none.
    const bloom::Bloom all(device(), {.share = 0.1f, .threshold = 0.0f});
    EXPECT_TRUE(all.ask(facts).run);
    facts.lastBrightest = 0.0f;
    EXPECT_FALSE(all.ask(facts).run);
}

TEST(BloomKnee, RisesFromNothingToAllThatIsAboveTheThreshold) {
    const float threshold = 2.0f;
    const float knee = 0.5f;
    const auto find = [&](float peak) {
        return peak * shader::findHighlightShare(peak, threshold, knee);
    };
    EXPECT_EQ(find(1.5f), 0.0f);
    EXPECT_NEAR(find(2.0f), 0.25f * knee, 1e-6f);
    EXPECT_NEAR(find(2.5f), 0.5f, 1e-6f);
    EXPECT_NEAR(find(60000.0f), 59998.0f, 1.0f);
    float last = 0.0f;
    for (float peak = 1.5f; peak < 3.0f; peak += 0.01f) {
        const float now = find(peak);
        EXPECT_GE(now, last);
        EXPECT_LE(now - last, 0.0101f) << peak; // no steps
        last = now;
    }
}

TEST(BloomKnee, HasNoWidthWhereNoneIsWanted) {
    EXPECT_EQ(shader::findHighlightShare(2.0f, 2.0f, 0.0f), 0.0f);
    EXPECT_EQ(shader::findHighlightShare(4.0f, 2.0f, 0.0f), 0.5f);
    EXPECT_EQ(shader::findHighlightShare(0.3f, 0.0f, 0.0f), 1.0f);
    EXPECT_EQ(shader::findHighlightShare(0.0f, 0.0f, 0.0f), 0.0f); // black
    EXPECT_EQ(shader::findHighlight({0.0f, 0.0f, 0.0f}, 1.0f, 1.0f), math::vec3(0.0f));
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

} // namespace
} // namespace shutter
