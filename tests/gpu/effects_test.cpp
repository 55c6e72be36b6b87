// SPDX-License-Identifier: MIT
// Effects around the blur, one on a rig: bloom spreads light and keeps it; the tone map against the
// same functions in C++; the longest motion of each entity against a loop.
#include "engine/render/longest_motion.h"
#include "modules/bloom/bloom.h"
#include "modules/tonemap/tonemap.h"
#include "shaders/bloom/bloom.glsl"
#include "shaders/tonemap/tonemap.glsl"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

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
        EXPECT_TRUE(test::decide(bloom, effect.facts).run);
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

TEST_F(Bloom, AUniformPictureIsUnchangedAndTheBrightestStaysFinite) {
    EXPECT_TRUE(test::allFinite(run(test::makePicture(96, 64, 65000.0f), 1.0f)));
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

TEST_F(Bloom, SpreadCoversTheSameShareOfThePictureAtEachResolution) {
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

TEST_F(Bloom, LightBelowTheKneeIsUnchanged) {
    image::Image noise = test::makeNoise(123, 77);
    for (float& value : noise.pixels)
        value = image::roundToHalf(0.25f + 0.25f * value); // the knee begins at 0.5
    const image::Image bloomed = run(noise, {.share = 0.8f, .threshold = 1.0f, .knee = 0.5f});
    for (size_t i = 0; i < noise.pixels.size(); ++i)
        ASSERT_EQ(bloomed.pixels[i], noise.pixels[i]) << i;
}

TEST_F(Bloom, LightAboveTheThresholdSpreadsAndTotalLightIsPreserved) {
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

TEST_F(Bloom, BloomRunsIfTheLastPictureHadAHighlightOrIsUnknown) {
    const bloom::BloomSettings settings{.share = 0.1f, .threshold = 2.0f, .knee = 0.25f};
    const bloom::Bloom bloom(device(), settings);
    EXPECT_EQ(bloom::findKneeStart(settings), 1.5f);
    render::ViewFacts facts;
    facts.width = 640;
    facts.height = 360;
    EXPECT_TRUE(test::decide(bloom, facts).run);
    facts.lastBrightest = 1.51f;
    EXPECT_TRUE(test::decide(bloom, facts).run);
    facts.lastBrightest = 1.5f;
    EXPECT_FALSE(test::decide(bloom, facts).run);
    EXPECT_NE(test::decide(bloom, facts).reason.find("knee"), std::string::npos);
    // Without a threshold all light is scattered; in the dark there is none.
    const bloom::Bloom all(device(), {.share = 0.1f, .threshold = 0.0f});
    EXPECT_TRUE(test::decide(all, facts).run);
    EXPECT_FALSE(test::decide(bloom::Bloom(device(), {0.0f}), facts).run);
    facts.lastBrightest = 0.0f;
    EXPECT_FALSE(test::decide(all, facts).run);
    facts = {};
    facts.width = 640;
    facts.height = 7;
    EXPECT_FALSE(test::decide(all, facts).run) << "a tiny picture";
    for (const glm::uvec3 levels :
         {glm::uvec3(7, 640, 0), {8, 640, 1}, {1920, 1080, 8}, {65536, 65536, 10}})
        EXPECT_EQ(bloom::countLevels(levels.x, levels.y), levels.z);
}

TEST(BloomKnee, TheKneeRisesFromZeroToAllLightAboveTheThreshold) {
    const float threshold = 2.0f;
    const float knee = 0.5f;
    const auto find = [&](float peak) {
        return peak * shader::findHighlightShare(peak, threshold, knee);
    };
    EXPECT_EQ(find(1.5f), 0.0f);
    EXPECT_NEAR(find(2.0f), 0.25f * knee, 1e-6f);
    EXPECT_NEAR(find(2.5f), 0.5f, 1e-6f);
    EXPECT_NEAR(find(60000.0f), 59998.0f, 1.0f);
    EXPECT_EQ(shader::findHighlightShare(4.0f, 2.0f, 0.0f), 0.5f) << "a knee of no width";
    EXPECT_EQ(shader::findHighlightShare(0.0f, 0.0f, 0.0f), 0.0f) << "black";
    float last = 0.0f;
    for (float peak = 1.5f; peak < 3.0f; peak += 0.01f) {
        const float now = find(peak);
        EXPECT_GE(now, last);
        EXPECT_LE(now - last, 0.0101f) << peak; // no steps
        last = now;
    }
}

class Tonemap : public test::GpuTest {};

image::Image makeColors(uint32_t width, uint32_t height) {
    image::Image colors(width, height, 4);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (uint32_t c = 0; c < 3; ++c) {
                // 0, then 1e-4 to 65000 by powers; another curve in each channel.
                const double share = double((x + 13 * c * (y + 1)) % width) / (width - 1);
                colors.at(x, y, c) =
                    share == 0.0 ? 0.0f : float(1e-4 * std::pow(6.5e8, share * (y + 1) / height));
            }
    return colors;
}

image::Image
runTonemap(gpu::Device& device, const image::Image& colors, const tonemap::TonemapSettings& how) {
    test::GraphRig rig(device);
    test::EffectRig effect(rig, rig.upload(colors), colors.width, colors.height);
    tonemap::Tonemap tonemap(device, how);
    tonemap.declare(effect.context);
    const size_t ticket = rig.want(effect.context.display);
    run(rig);
    return rig.take(ticket);
}

void expectAsInCpp(gpu::Device& device, const tonemap::TonemapSettings& how) {
    // No multiple of the group's 8: the last groups hang over.
    const image::Image colors = makeColors(131, 9);
    const image::Image display = runTonemap(device, colors, how);
    const float gain = std::exp2(float(how.exposureValue));
    for (uint32_t y = 0; y < colors.height; ++y)
        for (uint32_t x = 0; x < colors.width; ++x) {
            glm::vec3 color =
                glm::vec3(colors.at(x, y, 0), colors.at(x, y, 1), colors.at(x, y, 2)) * gain;
            if (how.op == tonemap::Operator::Neutral)
                color = shader::toneMapNeutral(color);
            const glm::vec3 expected = shader::encodeSrgb3(color);
            for (uint32_t c = 0; c < 3; ++c)
                // Half a step of 8 bits, and 1e-4 for the device's pow.
                ASSERT_NEAR(display.at(x, y, c), expected[int(c)], 0.5f / 255.0f + 1e-4f)
                    << x << ", " << y << " channel " << c;
            ASSERT_EQ(display.at(x, y, 3), 1.0f);
        }
}

TEST_F(Tonemap, EachMapperIsTheOneInCppAndTheExposureValueMultiplies) {
    expectAsInCpp(device(), {});
    expectAsInCpp(device(), {.op = tonemap::Operator::None});
    expectAsInCpp(device(), {.op = tonemap::Operator::None, .exposureValue = -2.5});
}

/// What a tone map that is used again and again measures of each picture; nothing where it is not
/// requested.
class BrightestChannel : public Tonemap {
  protected:
    std::optional<double> measure(const image::Image& colors, bool isWanted = true) {
        test::GraphRig rig(device());
        test::EffectRig effect(rig, rig.upload(colors), colors.width, colors.height);
        effect.facts.brightestWanted = isWanted;
        if (!mTonemap)
            mTonemap.emplace(device(), tonemap::TonemapSettings{.exposureValue = -3.0});
        mTonemap->declare(effect.context);
        const size_t ticket = rig.want(effect.context.display);
        test::run(rig);
        mDisplay = rig.take(ticket);
        render::Counters counters;
        render::Measures measures;
        std::vector<render::Explanation> explanations;
        render::FinishedFrame finished{0, true, {}, counters, measures, explanations};
        mTonemap->finish(finished);
        const auto found = measures.find(render::kBrightest);
        return found == measures.end() ? std::nullopt : std::optional(found->second);
    }

    std::optional<tonemap::Tonemap> mTonemap;
    image::Image mDisplay; ///< of the last one
};

TEST_F(BrightestChannel, TheMaximumIsFoundAtAnyPixel) {
    // No multiple of the group's 8.
    for (const auto at : {glm::uvec2(0, 0), glm::uvec2(130, 8), glm::uvec2(64, 3)})
        for (uint32_t channel = 0; channel < 3; ++channel) {
            image::Image picture = test::makePicture(131, 9, 0.125f);
            picture.at(at.x, at.y, channel) = 37.5f;
            EXPECT_EQ(measure(picture), 37.5) << at.x << ", " << at.y;
        }
    EXPECT_EQ(measure(test::makePicture(131, 9, 0.125f)), 0.125)
        << "the brighter ones are forgotten";
    EXPECT_EQ(measure(test::makePicture(16, 8, 0.0f)), 0.0) << "a smaller one after a larger one";
}

TEST_F(BrightestChannel, TheMaximumIsMeasuredOnRequestWithoutChangingThePicture) {
    const image::Image colors = makeColors(40, 24);
    EXPECT_TRUE(measure(colors).has_value());
    const image::Image measured = mDisplay;
    EXPECT_FALSE(measure(colors, false).has_value());
    EXPECT_EQ(measured.pixels, mDisplay.pixels);
}

TEST_F(BrightestChannel, NanCountsAsBlackAndInfinityAsTheMostThereIs) {
    image::Image picture = test::makePicture(24, 16, 0.5f);
    picture.at(3, 3, 1) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(measure(picture), 0.5);
    picture.at(4, 3, 1) = std::numeric_limits<float>::infinity();
    EXPECT_EQ(measure(picture), double(shader::kMaxColor));
    EXPECT_EQ(measure(test::makePicture(24, 16, -2.0f)), 0.0);
}

class LongestMotion : public test::GpuTest {};

constexpr uint32_t kEffectWidth = 53; // the last groups hang over
constexpr uint32_t kEffectHeight = 29;
constexpr uint32_t kEffectRows = 7; // row 6 has no pixels

struct LongestScene {
    image::Image motionDepth{kEffectWidth, kEffectHeight, 4};
    image::Image id{kEffectWidth, kEffectHeight, 1};
    std::vector<float> longest = std::vector<float>(kEffectRows + 1);

    LongestScene() {
        std::mt19937 random(11);
        std::uniform_real_distribution<float> component(-30.0f, 30.0f);
        for (uint32_t y = 0; y < kEffectHeight; ++y)
            for (uint32_t x = 0; x < kEffectWidth; ++x) {
                // Areas larger than a group, and a corner where every pixel is another's.
                const uint32_t row =
                    x > 40 ? random() % (kEffectRows + 1) : (x / 17 + 2 * (y / 15)) % 6;
                const bool isSky = row == kEffectRows || row == 6;
                const float speed = x % 3 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                               : component(random) / float(row + 1);
                motionDepth.at(x, y, 0) = speed;
                motionDepth.at(x, y, 1) = 0.5f * speed;
                id.at(x, y, 0) = isSky ? 4.0e9f : float(row);
                if (std::isnan(speed))
                    continue;
                float& own = longest[isSky ? kEffectRows : row];
                own = std::max(own, std::hypot(speed, 0.5f * speed));
            }
    }
};

TEST_F(LongestMotion, TheMeasureEqualsThatOfThePixels) {
    const LongestScene scene;
    render::LongestMotion effect(device());
    for (int again = 0; again < 2; ++again) { // a frame's numbers are its own
        test::GraphRig rig(device());
        const auto motionDepth = rig.upload(scene.motionDepth);
        test::EffectRig around(rig, motionDepth, kEffectWidth, kEffectHeight);
        around.gbuffer.motionDepth = motionDepth;
        around.gbuffer.entityId = rig.uploadIds(scene.id);
        around.frame.entities.resize(kEffectRows);
        effect.declare(around.context);
        test::run(rig);
        const std::vector<float> found = effect.take();
        ASSERT_EQ(found.size(), scene.longest.size());
        for (size_t row = 0; row < found.size(); ++row)
            EXPECT_NEAR(found[row], scene.longest[row], 1e-5f * scene.longest[row]) << row;
        EXPECT_EQ(found[6], 0.0f);
        EXPECT_GT(found[kEffectRows], 0.0f);
    }
}

} // namespace
} // namespace shutter
