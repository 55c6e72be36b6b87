// SPDX-License-Identifier: MIT
#include "modules/accumulate/accumulate.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <random>

namespace shutter {
namespace {

class Accumulate : public test::GpuTest {};

image::Image makeNoise(uint32_t width, uint32_t height, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0.0f, 3.0f);
    image::Image noise(width, height, 4);
    for (float& channel : noise.pixels)
        channel = value(random);
    return noise;
}

/// Adds the pictures one frame after the other; returns what the last frame made of them.
image::Image
addAll(gpu::Device& device, accumulate::Accumulate& sum, const std::vector<image::Image>& frames) {
    const auto count = static_cast<uint32_t>(frames.size());
    image::Image mean;
    for (uint32_t i = 0; i < count; ++i) {
        test::GraphRig rig(device);
        test::EffectRig effect(rig, rig.upload(frames[i]), frames[i].width, frames[i].height);
        sum.setInstant(i, count);
        sum.declare(effect.context);
        const size_t ticket = rig.want(effect.context.color);
        run(rig);
        mean = rig.take(ticket);
    }
    return mean;
}

void expectMean(const image::Image& mean, const std::vector<image::Image>& frames) {
    for (uint32_t y = 0; y < mean.height; ++y)
        for (uint32_t x = 0; x < mean.width; ++x)
            for (uint32_t c = 0; c < 3; ++c) {
                double sum = 0.0;
                for (const image::Image& frame : frames)
                    sum += double(frame.at(x, y, c));
                const double expected = sum / double(frames.size());
                // Single precision: one rounding per addition, of sums up to 15.
                ASSERT_NEAR(mean.at(x, y, c), expected, 1e-6 * double(frames.size()));
            }
}

TEST_F(Accumulate, TheLastFrameIsTheMeanOfAll) {
    accumulate::Accumulate sum(device());
    for (uint32_t count : {1u, 2u, 5u}) {
        std::vector<image::Image> frames;
        for (uint32_t i = 0; i < count; ++i)
            frames.push_back(makeNoise(19, 11, i));
        const image::Image mean = addAll(device(), sum, frames);
        ASSERT_EQ(mean.width, 19u);
        expectMean(mean, frames);
    }
}

TEST_F(Accumulate, ASecondPictureStartsFromNothingAndMayHaveAnotherSize) {
    accumulate::Accumulate sum(device());
    const std::vector<image::Image> first{makeNoise(8, 8, 1), makeNoise(8, 8, 2)};
    const std::vector<image::Image> same{makeNoise(8, 8, 3), makeNoise(8, 8, 4)};
    const std::vector<image::Image> larger{makeNoise(17, 9, 5), makeNoise(17, 9, 6)};
    expectMean(addAll(device(), sum, first), first);
    expectMean(addAll(device(), sum, same), same);
    expectMean(addAll(device(), sum, larger), larger);
}

} // namespace
} // namespace shutter
