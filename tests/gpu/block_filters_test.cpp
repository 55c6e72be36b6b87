// SPDX-License-Identifier: MIT
// What the filters do with the lists of blocks: still pixels, seams, and the floor of their cost.
#include "engine/image/image.h"
#include "modules/motion_blur/motion_blur.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/still_pixels.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace shutter {
namespace {

using glm::ivec2;
using glm::vec2;
using image::Image;
using motion_blur::getMethod;
using motion_blur::Method;
using motion_blur::MotionBlurSettings;
using test::makeNoise;
using test::makePicture;

class BlockFilters : public test::GpuTest {};

/// Frames on one effect, so that the second knows how much moved in the first.
class Effect {
  public:
    explicit Effect(gpu::Device& device)
        : mDevice(device), mEffect(device, VK_NULL_HANDLE), mStill(device) {}

    Image blur(
        const Image& color, const Image& motion, const MotionBlurSettings& settings, bool writable
    ) {
        test::GraphRig rig(mDevice);
        motion_blur::MotionBlurInputs inputs;
        // A transient: its usage follows from the passes.
        inputs.color = mStill.begin(
            rig.graph, rig.uploadColor(color), {}, motion_blur::StillPixelsBy::WholeCopy
        );
        inputs.motionDepth = rig.upload(motion);
        inputs.colorIsWritable = writable;
        const auto outputs = mEffect.add(rig.graph, inputs, settings);
        const size_t ticket = rig.want(outputs.color);
        const graph::Plan plan = run(rig);
        hasWholeCopy = false;
        for (const auto& pass : plan.passes)
            hasWholeCopy =
                hasWholeCopy ||
                (rig.graph.passes()[pass.pass].name == "copy still pixels" && pass.pass != 0);
        return rig.take(ticket);
    }

    /// \param kind "still", "uniform", "mixed" or "masked"
    [[nodiscard]] uint64_t countBlocks(const std::string& kind) const {
        return mEffect.counters().at("blocks " + kind);
    }

    bool hasWholeCopy = false; ///< of the effect's own, in the last frame

  private:
    gpu::Device& mDevice;
    motion_blur::MotionBlur mEffect;
    motion_blur::StillPixels mStill;
};

/// Those whose filters go over blocks and need no rays.
std::vector<const Method*> listBlockMethods() {
    std::vector<const Method*> methods;
    for (const Method* method : motion_blur::listMethods())
        if (method->countsBlocks && method->readsImagesOnly())
            methods.push_back(method);
    return methods;
}

/// One mover near the left border.
Image makeMover(uint32_t width, uint32_t height) {
    Image motion(width, height, 4);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const bool mover = x >= 20 && x < 30 && y >= 20 && y < 34;
            motion.at(x, y, 0) = mover ? 9.0f : 0.0f;
            motion.at(x, y, 2) = mover ? 2.0f : 5.0f;
        }
    return motion;
}

TEST_F(BlockFilters, WhereLittleMovesThePictureIsTheSameAndStillBlocksAreNotTouched) {
    const Image color = makeNoise(240, 96);
    const Image motion = makeMover(240, 96);
    MotionBlurSettings settings;
    settings.tileSizePx = 16;
    for (const Method* method : listBlockMethods()) {
        settings.method = method;
        Effect effect(device());
        const Image first = effect.blur(color, motion, settings, true);
        EXPECT_TRUE(effect.hasWholeCopy) << method->name << ": nothing is known yet";
        const Image second = effect.blur(color, motion, settings, true);
        EXPECT_FALSE(effect.hasWholeCopy) << method->name;
        EXPECT_TRUE(test::sameBits(first, second)) << method->name;
        EXPECT_FALSE(test::sameBits(first, color)) << method->name;
        const auto isFar = [](uint32_t x, uint32_t) { return x >= 72; };
        EXPECT_EQ(test::computeMaxDifferenceWhere(first, color, isFar), 0.0) << method->name;
        EXPECT_GT(effect.countBlocks("still"), 280u) << method->name << " of 360";
        effect.blur(color, motion, settings, false);
        EXPECT_TRUE(effect.hasWholeCopy) << "the picture may not be written";
    }
}

TEST_F(BlockFilters, MuchMotionIsWrittenOverACopyOfThePicture) {
    Image motion(64, 64, 4);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 64; ++x)
            motion.at(x, y, 0) = 5.0f;
    MotionBlurSettings settings;
    settings.method = &getMethod("gather");
    Effect effect(device());
    effect.blur(makeNoise(64, 64), motion, settings, true);
    effect.blur(makeNoise(64, 64), motion, settings, true);
    EXPECT_TRUE(effect.hasWholeCopy);
    EXPECT_EQ(effect.countBlocks("uniform"), 64u);
}

TEST(StillPixels, TheChoiceHasSlack) {
    using motion_blur::chooseStillPixels;
    using By = motion_blur::StillPixelsBy;
    for (const By last : {By::WholeCopy, By::CopyBack}) {
        EXPECT_EQ(chooseStillPixels(0.0, last), By::CopyBack);
        EXPECT_EQ(chooseStillPixels(0.25, last), last);
        EXPECT_EQ(chooseStillPixels(1.0, last), By::WholeCopy);
    }
}

TEST_F(BlockFilters, NoSeamShowsWhereUniformMotionMeetsMixed) {
    // One flat wall; motion is 12 px on the left and varies by more than the bound on the right.
    const Image color = makeNoise(192, 64);
    Image motion(192, 64, 4);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 192; ++x) {
            motion.at(x, y, 0) = x < 128 ? 12.0f : 12.0f - 0.1f * float(x % 8);
            motion.at(x, y, 2) = 3.0f;
        }
    MotionBlurSettings settings;
    settings.method = &getMethod("gather");
    settings.tileSizePx = 16;
    Effect effect(device());
    const Image fast = effect.blur(color, motion, settings, false);
    EXPECT_GT(effect.countBlocks("uniform"), 100u);
    EXPECT_GT(effect.countBlocks("mixed"), 40u);
    settings.uniformMotionPx = 0.0f;
    const Image full = effect.blur(color, motion, settings, false);
    EXPECT_EQ(effect.countBlocks("uniform"), 0u);
    const auto everywhere = [](uint32_t, uint32_t) { return true; };
    EXPECT_LE(test::computeMaxDifferenceWhere(fast, full, everywhere), 0.5 / 255.0);
}

TEST_F(BlockFilters, OverDepthStepsThatMoveAlikeTheUniformPathIsNearerToTheTruth) {
    // Everything moves by 16 px to the right, whatever its depth: each pixel saw the mean of what
    // lies 16 px before it.
    constexpr uint32_t kWide = 192;
    const Image color = makeNoise(kWide, 64);
    Image motion(kWide, 64, 4);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < kWide; ++x) {
            motion.at(x, y, 0) = 16.0f;
            motion.at(x, y, 2) = x / 24 % 2 == 0 ? 2.0f : 6.0f;
        }
    // With the paper's numbers, whose full path takes the nearer stripes for smears over the
    // others.
    MotionBlurSettings settings = motion_blur::paperSettings();
    settings.method = &getMethod("gather");
    settings.sampleCount = 64;
    Effect effect(device());
    const auto error = [&](float uniformMotionPx) {
        settings.uniformMotionPx = uniformMotionPx;
        const Image picture = effect.blur(color, motion, settings, false);
        double sum = 0.0;
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 32; x < kWide - 32; ++x) {
                double truth = 0.0;
                for (uint32_t i = 0; i < 1024; ++i) {
                    const double place = x + 0.5 + 16.0 * (i + 0.5) / 1024.0;
                    truth += color.at(uint32_t(place), y, 0) / 1024.0;
                }
                sum += std::pow(picture.at(x, y, 0) - truth, 2.0);
            }
        return sum;
    };
    const double full = error(0.0f);
    const double fast = error(0.5f);
    EXPECT_LT(fast, 0.5 * full);
}

TEST_F(BlockFilters, WhatLiesBeyondTheDepthLimitCountsAsStill) {
    const Image color = makeNoise(96, 64);
    Image motion(96, 64, 4);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 96; ++x) {
            motion.at(x, y, 0) = 3.0f + 0.1f * float(y % 7);
            motion.at(x, y, 2) = x % 24 < 12 ? 4.0f : (y < 32 ? 40.0f : 1e9f); // below: the sky
        }
    Image near = motion;
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 96; ++x)
            if (x % 24 >= 12)
                near.at(x, y, 0) = 0.0f;
    for (const Method* method : listBlockMethods()) {
        MotionBlurSettings settings;
        settings.method = method;
        settings.tileSizePx = 16;
        settings.occluderTest = motion_blur::OccluderTest::Velocity;
        Effect effect(device());
        const Image unlimited = effect.blur(color, motion, settings, false);
        settings.maxMotionDepth = 10.0f;
        const Image limited = effect.blur(color, motion, settings, false);
        EXPECT_FALSE(test::sameBits(unlimited, limited)) << method->name;
        settings.maxMotionDepth = std::numeric_limits<float>::infinity();
        EXPECT_TRUE(test::sameBits(effect.blur(color, near, settings, false), limited))
            << method->name;
        settings.maxMotionDepth = 0.0f;
        EXPECT_TRUE(test::sameBits(effect.blur(color, motion, settings, false), color))
            << method->name;
        EXPECT_EQ(effect.countBlocks("still"), 12u * 8u) << method->name;
    }
}

} // namespace
} // namespace shutter
