// SPDX-License-Identifier: MIT
// The tone mapper on the device against the same functions in C++.
#include "modules/tonemap/tonemap.h"
#include "shaders/tonemap/tonemap.glsl"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <cmath>

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

} // namespace
} // namespace shutter
