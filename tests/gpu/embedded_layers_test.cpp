// SPDX-License-Identifier: MIT
// Views in the layers of one image, such as a headset's eyes: each is blurred as if it were an
// image of its own, and the other layers stay as they are.
#include "engine/gpu/frame.h"
#include "tests/gpu/embedding_host.h"
#include "tests/gpu/layered_image.h"
#include "tests/support/picture.h"

#include <array>
#include <memory>

namespace shutter {
namespace {

using motion_blur::HostInputs;
using test::kCopied;
using test::kNothing;
using test::kSampled;
using test::kWritten;
using test::TwoLayers;

constexpr uint32_t kWidth = 48;
constexpr uint32_t kHeight = 32;
constexpr VkExtent2D kExtent{kWidth, kHeight};

template <class Texel, class Make> gpu::Buffer makeTexels(gpu::Device& device, const Make& make) {
    std::vector<Texel> texels;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x)
            texels.push_back(make(x, y));
    gpu::Buffer buffer(device, "texels", texels.size() * sizeof(Texel), 0, gpu::MemoryUse::Staging);
    buffer.write(std::span<const Texel>(texels));
    return buffer;
}

class EmbeddedLayers : public test::EmbeddedTest {};

TEST_F(EmbeddedLayers, AreBlurredLikeImagesOfTheirOwn) {
    const auto blur = create(describeHost());
    ASSERT_TRUE(blur);
    const TwoLayers color(device(), VK_FORMAT_R16G16B16A16_SFLOAT, kExtent);
    const TwoLayers motion(device(), VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
    const TwoLayers output(device(), VK_FORMAT_R16G16B16A16_SFLOAT, kExtent);
    const auto colors = makeTexels<uint64_t>(device(), [](uint32_t x, uint32_t y) {
        return glm::packHalf4x16({float(x / 8 % 2), 0.5f * float(y / 8 % 2), 0.25f, 1.0f});
    });
    const auto motions = makeTexels<glm::vec4>(device(), [](uint32_t x, uint32_t) {
        return glm::vec4(x < 24 ? 9.0f : -5.0f, 2.0f, 3.0f, 0.0f);
    });
    test::HostFrame alone(device(), kWidth, kHeight);
    const test::Picture wanted(device(), "wanted", {kWidth, kHeight});
    const std::array<test::Picture, 2> made{
        test::Picture(device(), "made", {kWidth, kHeight}),
        test::Picture(device(), "made", {kWidth, kHeight})};
    gpu::Frame frame(device());
    frame.begin();
    const VkCommandBuffer commands = frame.commands();
    // Layer 1 has the picture; layer 0 is somebody else's, in a layout of its own.
    color.copyFrom(commands, colors, 1);
    motion.copyFrom(commands, motions, 1);
    for (const TwoLayers* image : {&color, &motion})
        test::moveOn(commands, image->image, kNothing, kCopied);
    output.copyFrom(commands, colors, 0);
    test::moveOn(commands, output.image, kWritten, kCopied);
    HostInputs inputs;
    inputs.width = kWidth;
    inputs.height = kHeight;
    inputs.color = {color.image, kWritten, kSampled};
    inputs.motionDepth = {motion.image, kWritten, kSampled};
    inputs.output = {output.image, kNothing, kCopied};
    inputs.color.layer = inputs.motionDepth.layer = inputs.output.layer = 1;
    const core::Status done = blur->record(commands, 0, inputs, test::gather());
    ASSERT_TRUE(done.ok()) << done.error().message;
    // The same from images of their own.
    const auto fill = [&](const gpu::Image& image, const gpu::Buffer& texels) {
        test::moveOn(commands, image.handle(), kNothing, kWritten);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {kWidth, kHeight, 1};
        vkCmdCopyBufferToImage(
            commands, texels.handle(), image.handle(), kWritten.layout, 1, &region
        );
    };
    fill(alone.color, colors);
    fill(alone.motionDepth, motions);
    HostInputs own = alone.inputs();
    own.output = {wanted.handle(), kNothing, kCopied};
    ASSERT_TRUE(blur->record(commands, 1, own, test::gather()).ok());
    for (uint32_t layer = 0; layer < 2; ++layer) {
        test::moveOn(commands, made[layer].handle(), kNothing, kWritten);
        VkImageCopy region{};
        region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
        region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.extent = {kWidth, kHeight, 1};
        vkCmdCopyImage(
            commands,
            output.image,
            kCopied.layout,
            made[layer].handle(),
            kWritten.layout,
            1,
            &region
        );
        test::moveOn(commands, made[layer].handle(), kWritten, kCopied);
        made[layer].recordReadback(commands);
    }
    wanted.recordReadback(commands);
    frame.submit();
    frame.wait();
    EXPECT_TRUE(test::sameBits(made[1].read(), wanted.read()));
    EXPECT_FALSE(test::sameBits(made[0].read(), wanted.read())) << "layer 0 is the sharp picture";
}

} // namespace
} // namespace shutter
