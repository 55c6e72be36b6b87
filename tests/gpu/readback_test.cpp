// SPDX-License-Identifier: MIT
// Pictures of formats that only windows have come back as what was shown.
#include "engine/gpu/upload.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <array>
#include <cstdint>
#include <span>

namespace shutter {
namespace {

class Readback : public test::GpuTest {};

TEST_F(Readback, TenBitsAChannelAreReadInTheOrderOfTheirFormat) {
    constexpr uint32_t kLow = 0;
    constexpr uint32_t kMiddle = 341; // a third of 1023
    constexpr uint32_t kHigh = 1023;
    const std::array<uint32_t, 2> texels{
        kLow | kMiddle << 10 | kHigh << 20 | 3u << 30, kHigh | kLow << 10 | kMiddle << 20};
    for (const bool redIsLow : {true, false}) {
        gpu::ImageDesc desc;
        desc.width = texels.size();
        desc.height = 1;
        desc.format =
            redIsLow ? VK_FORMAT_A2B10G10R10_UNORM_PACK32 : VK_FORMAT_A2R10G10B10_UNORM_PACK32;
        desc.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                     VK_IMAGE_USAGE_SAMPLED_BIT;
        gpu::Image image(device(), "ten bits", desc);
        gpu::uploadTexture(device(), image, std::as_bytes(std::span(texels)));
        test::GraphRig rig(device());
        const size_t ticket = rig.want(rig.graph.importImage(
            "ten bits", image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_UNDEFINED
        ));
        test::run(rig);
        const image::Image read = rig.take(ticket);
        const uint32_t red = redIsLow ? 0 : 2;
        EXPECT_EQ(read.at(0, 0, red), 0.0f);
        EXPECT_FLOAT_EQ(read.at(0, 0, 1), 1.0f / 3.0f);
        EXPECT_EQ(read.at(0, 0, 2 - red), 1.0f);
        EXPECT_EQ(read.at(0, 0, 3), 1.0f);
        EXPECT_EQ(read.at(1, 0, red), 1.0f);
        EXPECT_EQ(read.at(1, 0, 1), 0.0f);
        EXPECT_FLOAT_EQ(read.at(1, 0, 2 - red), 1.0f / 3.0f);
        EXPECT_EQ(read.at(1, 0, 3), 0.0f);
    }
}

} // namespace
} // namespace shutter
