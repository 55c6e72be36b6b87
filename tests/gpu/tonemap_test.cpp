// SPDX-License-Identifier: MIT
// The tone mapper on the device against the same functions in C++.
#include "modules/tonemap/tonemap.h"
#include "shaders/tonemap/tonemap.glsl"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <cmath>
#include <limits>
#include <optional>

namespace shutter {
namespace {

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

TEST_F(Tonemap, TheNeutralMapperIsTheOneInCpp) {
    expectAsInCpp(device(), {});
}

TEST_F(Tonemap, NoMapperCutsOffAndEncodes) {
    expectAsInCpp(device(), {.op = tonemap::Operator::None});
}

TEST_F(Tonemap, TheExposureValueMultiplies) {
    expectAsInCpp(device(), {.op = tonemap::Operator::None, .exposureValue = -2.5});
}

/// What a tone map that is used again and again measures of each picture; nothing where it is not
/// asked.
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

TEST_F(BrightestChannel, IsFoundWhereverItIs) {
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

TEST_F(BrightestChannel, IsMeasuredForThoseWhoAskAndChangesNothing) {
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

} // namespace
} // namespace shutter
