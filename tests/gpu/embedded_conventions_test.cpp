// SPDX-License-Identifier: MIT
// A host may bring its images in other formats, conventions and places than the motion blur's own:
// the picture is the same, to the bit where nothing is rounded on the way.
#include "engine/image/metrics.h"
#include "engine/math/transform.h"
#include "shaders/motion_blur/overlay.glsl"
#include "tests/gpu/embedding_host.h"
#include "tests/support/picture.h"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace shutter {
namespace {

using motion_blur::HostConvention;
using motion_blur::HostImage;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using test::HostTexels;
using test::packHalf;

constexpr uint32_t kConventionWidth = 96;
constexpr uint32_t kConventionHeight = 64;
constexpr VkExtent2D kConventionExtent{kConventionWidth, kConventionHeight};
constexpr float kNear = 0.125f;
constexpr size_t kConventionPixels = size_t{kConventionWidth} * kConventionHeight;

/// What a host drew, in main memory: rectangles before a wall, and sky above it.
struct Drawn {
    std::vector<glm::vec4> color{kConventionPixels};
    std::vector<glm::vec2> motion{
        kConventionPixels}; ///< pixels over the exposure; quarters, halves hold them
    std::vector<float> metres = std::vector<float>(kConventionPixels);
    std::vector<uint32_t> ids = std::vector<uint32_t>(kConventionPixels);
};

Drawn paint() {
    Drawn drawn;
    std::mt19937 random(5);
    for (uint32_t y = 0; y < kConventionHeight; ++y)
        for (uint32_t x = 0; x < kConventionWidth; ++x) {
            const size_t at = size_t{y} * kConventionWidth + x;
            // Sixteenths: half floats, and the packed format's 5 bits, hold them.
            const auto noise = float(random() % 16) / 16.0f;
            drawn.color[at] = {0.5f, 0.25f + noise / 2.0f, noise, 1.0f};
            drawn.motion[at] = {0.0f, 0.0f};
            drawn.metres[at] = 16.0f;
            drawn.ids[at] = 1;
            if (y < 16) { // even borders, so that half of the resolution loses none
                drawn.metres[at] = 1.0e9f;
                drawn.ids[at] = 0xFFFFFFFF;
            } else if (x >= 30 && x < 60 && y >= 20 && y < 50) {
                drawn.color[at] = {4.0f, 0.5f, 0.125f, 1.0f};
                drawn.motion[at] = {12.0f, -4.0f};
                drawn.metres[at] = 2.0f;
                drawn.ids[at] = 7;
            } else if (x >= 66 && x < 80 && y >= 30 && y < 60) {
                drawn.color[at] = {0.0f, 0.5f, 3.0f, 1.0f};
                drawn.motion[at] = {-6.5f, 10.0f};
                drawn.metres[at] = 4.0f;
                drawn.ids[at] = 200;
            }
        }
    return drawn;
}

template <class T, class Values, class Change>
std::vector<T> convert(const Values& values, const Change& change) {
    std::vector<T> result;
    for (const auto& value : values)
        result.push_back(change(value));
    return result;
}

/// The picture's texels within a larger image.
template <class T>
std::vector<T> surround(
    const std::vector<T>& inner, const T& outside, const VkExtent2D& whole, const VkOffset2D& at
) {
    std::vector<T> texels(size_t{whole.width} * whole.height, outside);
    for (uint32_t y = 0; y < kConventionHeight; ++y)
        for (uint32_t x = 0; x < kConventionWidth; ++x)
            texels[size_t{y + uint32_t(at.y)} * whole.width + x + uint32_t(at.x)] =
                inner[size_t{y} * kConventionWidth + x];
    return texels;
}

class EmbeddedConventions : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        drawn = paint();
    }

    template <class T>
    HostImage
    make(VkFormat format, const std::vector<T>& values, VkExtent2D extent = kConventionExtent) {
        return makeTexels(format, extent, values).describe();
    }

    /// The values around the picture's in a larger image.
    template <class T>
    HostImage makePart(
        VkFormat format,
        const std::vector<T>& inner,
        const T& outside,
        VkExtent2D whole,
        VkRect2D area
    ) {
        return makeTexels(format, whole, surround(inner, outside, whole, area.offset))
            .describe(area);
    }

    /// Whether images of the format may be used so.
    static bool canUse(VkFormat format, VkFormatFeatureFlags features) {
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(device().physical(), format, &properties);
        return (properties.optimalTilingFeatures & features) == features;
    }

    HostImage color() {
        return make(VK_FORMAT_R16G16B16A16_SFLOAT, convert<uint64_t>(drawn.color, packHalf));
    }

    HostImage ownMotionDepth() {
        std::vector<glm::vec4> texels;
        for (size_t i = 0; i < kConventionPixels; ++i)
            texels.emplace_back(drawn.motion[i], drawn.metres[i], 0.0f);
        return make(VK_FORMAT_R32G32B32A32_SFLOAT, texels);
    }

    HostInputs ownInputs() {
        HostInputs inputs;
        inputs.width = kConventionWidth;
        inputs.height = kConventionHeight;
        inputs.color = color();
        inputs.motionDepth = ownMotionDepth();
        return inputs;
    }

    /// The same in a convention that rounds nothing.
    HostInputs conventionInputs() {
        HostInputs inputs = ownInputs();
        inputs.motionDepth = {};
        HostConvention& convention = inputs.convention;
        convention.vectors.image = make(VK_FORMAT_R32G32_SFLOAT, drawn.motion);
        convention.depth.image = make(VK_FORMAT_R32_SFLOAT, drawn.metres);
        convention.depth.isLinear = true;
        convention.depth.skyValue = 1.0e9f;
        convention.scales.exposureShare = 1.0f;
        return inputs;
    }

    void useReversedInfiniteCamera(HostConvention& convention) {
        convention.depth.isLinear = false;
        convention.depth.skyValue = 0.0f;
        convention.cameras.areGiven = true;
        convention.cameras.clipFromView = math::clipFromViewPerspective(1.0, 1.5, double(kNear));
        convention.cameras.clipFromViewBefore = convention.cameras.clipFromView;
    }

    /// Linear depth, and a camera that moves by half a metre.
    HostInputs movingCameraInputs() {
        HostInputs inputs = conventionInputs();
        HostConvention& convention = inputs.convention;
        useReversedInfiniteCamera(convention);
        convention.depth.isLinear = true;
        convention.depth.skyValue = 1.0e9f;
        convention.cameras.viewFromWorldBefore =
            glm::translate(math::dmat4(1.0), math::dvec3(0.5, 0.0, 0.0));
        return inputs;
    }

    /// Draws with `inputs` as they are, and reads what `target` holds then.
    template <class T> std::vector<T> blurInto(const HostTexels& target, const HostInputs& inputs) {
        const VkExtent2D extent = target.extent();
        const size_t count = size_t{extent.width} * extent.height;
        const gpu::Buffer copy(device(), "copy", count * sizeof(T), 0, gpu::MemoryUse::Readback);
        run(inputs, test::gather(), 0, [&](VkCommandBuffer commands) {
            test::copyToBuffer(commands, target.image(), copy);
        });
        std::vector<T> texels(count);
        std::memcpy(texels.data(), copy.mapped(), count * sizeof(T));
        return texels;
    }

    template <class T>
    std::vector<std::byte> blurIntoBytes(const HostTexels& target, const HostInputs& inputs) {
        const std::vector<T> texels = blurInto<T>(target, inputs);
        const auto bytes = test::bytesOf(texels);
        return {bytes.begin(), bytes.end()};
    }

    core::Status refuse(HostInputs inputs, const MotionBlurSettings& settings) {
        const test::Picture output(device(), {inputs.width, inputs.height});
        inputs.output = output.output();
        core::Status done;
        submit([&](VkCommandBuffer commands) {
            done = mBlur->record(commands, 0, inputs, settings);
        });
        return done;
    }

    /// The picture's part of `target` contains it, the rest is unchanged.
    void expectPart(
        const HostTexels& target,
        const HostInputs& inputs,
        const VkRect2D& area,
        const std::vector<uint64_t>& was,
        const image::Image& own
    ) {
        const auto texels = blurInto<uint64_t>(target, inputs);
        const uint32_t width = target.extent().width;
        size_t wrong = 0;
        for (size_t i = 0; i < texels.size(); ++i) {
            const auto x = uint32_t(i % width) - uint32_t(area.offset.x);
            const auto y = uint32_t(i / width) - uint32_t(area.offset.y);
            if (x >= kConventionWidth || y >= kConventionHeight) {
                wrong += texels[i] != was[i];
                continue;
            }
            const glm::vec4 value = glm::unpackHalf4x16(texels[i]);
            wrong += std::memcmp(
                         &value, &own.pixels[4 * (size_t{y} * kConventionWidth + x)], sizeof(value)
                     ) != 0;
        }
        EXPECT_EQ(wrong, 0u);
    }

    Drawn drawn;
};

void expectNear(const image::Image& made, const image::Image& own, double psnrDb) {
    EXPECT_TRUE(test::allFinite(made));
    EXPECT_GT(image::computePsnr(made, own), psnrDb);
}

TEST_F(EmbeddedConventions, VectorsAndDepthApartGiveTheSameBits) {
    const image::Image own = draw(ownInputs());
    EXPECT_TRUE(test::sameBits(draw(conventionInputs()), own));
    EXPECT_FALSE(test::sameBits(
        own,
        [&] {
            HostInputs cut = conventionInputs();
            cut.convention.scales.isCut = true;
            return draw(cut);
        }()
    )) << "nothing was blurred";
}

/// Signs and scales of units are those of the shader's code run as C++
/// (tests/unit/motion_blur/host_convention_test.cpp).
TEST_F(EmbeddedConventions, EachFormatOfVectorsIsTheSamePicture) {
    const image::Image own = draw(ownInputs());
    HostInputs inputs = conventionInputs();
    auto& declared = inputs.convention.vectors;
    declared.pixelsPerUnit = {-0.5f * kConventionWidth, 0.5f * kConventionHeight};
    const auto vectors = convert<glm::vec2>(drawn.motion, [&](const glm::vec2& motion) {
        return motion / declared.pixelsPerUnit;
    });
    const auto wide = convert<glm::vec4>(vectors, [](const glm::vec2& value) {
        return glm::vec4(value, 99.0f, -5.0f); // the other channels are the host's own affair
    });
    const auto halves =
        convert<uint32_t>(vectors, [](const glm::vec2& value) { return glm::packHalf2x16(value); });
    declared.image = make(VK_FORMAT_R32G32_SFLOAT, vectors);
    expectNear(draw(inputs), own, 70.0);
    declared.image = make(VK_FORMAT_R32G32B32A32_SFLOAT, wide);
    expectNear(draw(inputs), own, 70.0);
    declared.image = make(VK_FORMAT_R16G16B16A16_SFLOAT, convert<uint64_t>(wide, packHalf));
    expectNear(draw(inputs), own, 50.0);
    declared.image = make(VK_FORMAT_R16G16_SFLOAT, halves);
    expectNear(draw(inputs), own, 50.0);
}

TEST_F(EmbeddedConventions, EachFormatOfDepthIsTheSamePicture) {
    const image::Image own = draw(ownInputs());
    // Powers of two: near / metres is exact.
    const auto raw = convert<float>(drawn.metres, [](float metres) {
        return metres < 1.0e9f ? kNear / metres : 0.0f;
    });
    HostInputs inputs = conventionInputs();
    useReversedInfiniteCamera(inputs.convention);
    for (const VkFormat format :
         {VK_FORMAT_D32_SFLOAT, VK_FORMAT_R32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
        SCOPED_TRACE(gpu::nameFormat(format));
        inputs.convention.depth.image = make(format, raw);
        EXPECT_TRUE(test::sameBits(draw(inputs), own));
    }
    inputs.convention.depth.image =
        make(VK_FORMAT_D16_UNORM, convert<uint16_t>(raw, [](float value) {
                 return uint16_t(value * 65535.0f + 0.5f);
             }));
    expectNear(draw(inputs), own, 60.0);
}

TEST_F(EmbeddedConventions, PartsOfLargerImagesGiveTheSameBitsAndTouchNothingElse) {
    const image::Image own = draw(ownInputs());
    constexpr VkExtent2D kWhole{kConventionWidth + 37, kConventionHeight + 21};
    constexpr VkFormat kHalf = VK_FORMAT_R16G16B16A16_SFLOAT;
    const auto halves = convert<uint64_t>(drawn.color, packHalf);
    const uint64_t bright = packHalf(glm::vec4(900.0f));
    HostInputs inputs = conventionInputs();
    HostConvention& convention = inputs.convention;
    const auto useArea = [&](VkRect2D area) {
        const glm::vec2 far(30.0f);
        convention.vectors.image =
            makePart(VK_FORMAT_R32G32_SFLOAT, drawn.motion, far, kWhole, area);
        convention.depth.image = makePart(VK_FORMAT_R32_SFLOAT, drawn.metres, 0.5f, kWhole, area);
        inputs.color = makePart(kHalf, halves, bright, kWhole, {area.offset, kConventionExtent});
        EXPECT_TRUE(test::sameBits(draw(inputs), own));
    };
    useArea({{37, 21}, {0, 0}}); // the rest of the extent
    constexpr VkRect2D kArea{{29, 13}, kConventionExtent};
    useArea(kArea);

    const std::vector<uint64_t> blank(size_t{kWhole.width} * kWhole.height, bright);
    const HostTexels& target = makeTexels(kHalf, kWhole, blank, VK_IMAGE_USAGE_STORAGE_BIT);
    inputs.output = target.describe(kArea);
    expectPart(target, inputs, kArea, blank, own);
    // In place, too.
    const auto whole = surround(halves, bright, kWhole, kArea.offset);
    const HostTexels& colors = makeTexels(kHalf, kWhole, whole, VK_IMAGE_USAGE_STORAGE_BIT);
    inputs.color = colors.describe(kArea);
    inputs.output = {};
    expectPart(colors, inputs, kArea, whole, own);
}

TEST_F(EmbeddedConventions, ALayerIsBlurredLikeAnImageOfItsOwnAndTheOthersStay) {
    const image::Image own = draw(ownInputs());
    const image::Image sharp = [&] {
        HostInputs off = ownInputs();
        off.isOff = true;
        return draw(off);
    }();
    mTexels.clear();
    const HostInputs alone = ownInputs(); // whose texels are copied into layers
    const test::TwoLayers color(device(), alone.color.format, kConventionExtent);
    const test::TwoLayers motion(device(), alone.motionDepth.format, kConventionExtent);
    const test::TwoLayers output(device(), alone.color.format, kConventionExtent);
    const std::array<test::Picture, 2> made{
        test::Picture(device(), {kConventionWidth, kConventionHeight}),
        test::Picture(device(), {kConventionWidth, kConventionHeight})};
    submit([&](VkCommandBuffer commands) {
        color.copyFrom(commands, mTexels[0].staging(), 1);
        motion.copyFrom(commands, mTexels[1].staging(), 1);
        output.copyFrom(commands, mTexels[0].staging(), 0);
        // Layer 0 belongs to another user, in another layout.
        color.move(commands, test::kNothing, test::kCopied, 0);
        motion.move(commands, test::kNothing, test::kCopied, 0);
        output.move(commands, test::kWritten, test::kCopied, 0);
        HostInputs inputs = alone;
        inputs.color.image = color.image;
        inputs.motionDepth.image = motion.image;
        inputs.output = {output.image, test::kNothing, test::kCopied};
        inputs.color.layer = inputs.motionDepth.layer = inputs.output.layer = 1;
        const core::Status done = mBlur->record(commands, 0, inputs, test::gather());
        EXPECT_TRUE(done.ok()) << done.error().message;
        for (uint32_t layer = 0; layer < 2; ++layer) {
            const VkImage to = made[layer].handle();
            const VkImageCopy region = test::wholeCopy(kConventionWidth, kConventionHeight, layer);
            test::moveOn(commands, to, test::kNothing, test::kWritten);
            vkCmdCopyImage(
                commands, output.image, test::kCopied.layout, to, test::kWritten.layout, 1, &region
            );
            test::moveOn(commands, to, test::kWritten, test::kCopied);
            made[layer].recordReadback(commands);
        }
    });
    EXPECT_TRUE(test::sameBits(made[1].read(), own));
    EXPECT_TRUE(test::sameBits(made[0].read(), sharp));
}

TEST_F(EmbeddedConventions, ColoursOfOtherFormatsAreBlurredAlike) {
    const image::Image own = draw(ownInputs());
    HostInputs inputs = ownInputs();
    const HostTexels& wide = makeTexels(
        VK_FORMAT_R32G32B32A32_SFLOAT, kConventionExtent, drawn.color, VK_IMAGE_USAGE_STORAGE_BIT
    );
    inputs.color = wide.describe();
    EXPECT_TRUE(test::sameBits(draw(inputs), own));
    const auto inPlace = blurInto<glm::vec4>(wide, inputs);
    EXPECT_EQ(
        std::memcmp(inPlace.data(), own.pixels.data(), kConventionPixels * sizeof(glm::vec4)), 0
    );

    constexpr VkFormat kPacked = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    if (!canUse(kPacked, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        GTEST_SKIP() << "the device stores no B10G11R11";
    const auto packed = convert<uint32_t>(drawn.color, [](const glm::vec4& value) {
        return glm::packF2x11_1x10(glm::vec3(value));
    });
    const HostTexels& small =
        makeTexels(kPacked, kConventionExtent, packed, VK_IMAGE_USAGE_STORAGE_BIT);
    inputs.color = small.describe();
    EXPECT_TRUE(test::sameBits(draw(inputs), own));
    const auto stored = blurInto<uint32_t>(small, inputs);
    size_t wrong = 0;
    for (size_t i = 0; i < kConventionPixels; ++i) {
        const glm::vec3 value = glm::unpackF2x11_1x10(stored[i]);
        for (int channel = 0; channel < 3; ++channel) {
            const float wanted = own.pixels[4 * i + channel];
            wrong += std::abs(value[channel] - wanted) > wanted / 32.0f + 1.0e-4f; // blue: 5 bits
        }
    }
    EXPECT_EQ(wrong, 0u);
}

/// Colours of four channels as an image stores them.
struct StoredColors {
    VkFormat format;
    double most;                                     ///< of red, green and blue
    std::function<uint64_t(const glm::dvec4&)> pack; ///< of whole numbers
    std::function<glm::dvec3(uint64_t)> unpack;
    size_t bytes;
};

std::vector<StoredColors> listStoredColors() {
    const auto shift = [](VkFormat format, int bits, int red, int blue) {
        const double most = std::pow(2.0, bits) - 1.0;
        const uint64_t mask = (uint64_t{1} << bits) - 1;
        return StoredColors{
            format,
            most,
            [=](const glm::dvec4& c) {
                return uint64_t(c.r) << red | uint64_t(c.g) << bits | uint64_t(c.b) << blue |
                       uint64_t(c.a) << 3 * bits;
            },
            [=](uint64_t word) {
                return glm::dvec3(word >> red & mask, word >> bits & mask, word >> blue & mask);
            },
            bits == 16 ? 8u : 4u};
    };
    return {
        shift(VK_FORMAT_R8G8B8A8_UNORM, 8, 0, 16),
        shift(VK_FORMAT_B8G8R8A8_UNORM, 8, 16, 0),
        shift(VK_FORMAT_A2B10G10R10_UNORM_PACK32, 10, 0, 20),
        shift(VK_FORMAT_A2R10G10B10_UNORM_PACK32, 10, 20, 0),
        shift(VK_FORMAT_R16G16B16A16_UNORM, 16, 0, 32),
        shift(VK_FORMAT_R8G8B8A8_SRGB, 8, 0, 16),
        shift(VK_FORMAT_B8G8R8A8_SRGB, 8, 16, 0)};
}

/// Each format by each curve, in place: what is static gets its own bits back, and what moves is
/// the mean of light.
TEST_F(EmbeddedConventions, StoredColoursAreBlurredAsLight) {
    std::mt19937 random(3);
    for (const StoredColors& stored : listStoredColors()) {
        if (!canUse(stored.format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
            continue;
        const bool isSrgb =
            stored.format == VK_FORMAT_R8G8B8A8_SRGB || stored.format == VK_FORMAT_B8G8R8A8_SRGB;
        for (const motion_blur::HostTransfer transfer :
             {motion_blur::HostTransfer{},
              {shader::kTransferSrgb},
              {shader::kTransferPower, 2.2, 2.0}}) {
            SCOPED_TRACE(fmt::format("{} by {}", gpu::nameFormat(stored.format), transfer.curve));
            const shader::Transfer curve = isSrgb
                                               ? shader::Transfer{shader::kTransferSrgb, 1.0f, 1.0f}
                                               : motion_blur::decodingOf(transfer, stored.format);
            // What half floats hold of 16 bits is 11.
            const double step = stored.most > 1023.0 ? 64.0 : 1.0;
            std::vector<uint64_t> words;
            std::vector<uint64_t> light;
            for (size_t i = 0; i < kConventionPixels; ++i) {
                glm::dvec4 value(0.0, 0.0, 0.0, 1.0);
                for (int channel = 0; channel < 3; ++channel)
                    value[channel] = double(random() % uint32_t(stored.most / step + 1.0)) * step;
                words.push_back(stored.pack(value));
                light.push_back(
                    packHalf({shader::lightOfColor(curve, glm::vec3(value / stored.most)), 1.0f})
                );
            }
            HostInputs linear = ownInputs();
            linear.color = make(VK_FORMAT_R16G16B16A16_SFLOAT, light);
            const image::Image own = draw(linear);
            std::vector<std::byte> bytes(words.size() * stored.bytes);
            for (size_t i = 0; i < words.size(); ++i)
                std::memcpy(&bytes[i * stored.bytes], &words[i], stored.bytes);
            const HostTexels& texels = makeTexels(stored.format, kConventionExtent, bytes);
            HostInputs inputs = linear;
            inputs.color = texels.describe();
            inputs.transfer = transfer;
            const std::vector<std::byte> made = stored.bytes == 8
                                                    ? blurIntoBytes<uint64_t>(texels, inputs)
                                                    : blurIntoBytes<uint32_t>(texels, inputs);
            size_t changed = 0;
            double worst = 0.0;
            for (size_t i = 0; i < words.size(); ++i) {
                uint64_t word = 0;
                std::memcpy(&word, &made[i * stored.bytes], stored.bytes);
                changed += word != words[i];
                for (int channel = 0; channel < 3; ++channel) {
                    const double wanted =
                        shader::valueOfLight(curve, own.pixels[4 * i + channel]) * stored.most;
                    worst = std::max(worst, std::abs(stored.unpack(word)[channel] - wanted));
                }
            }
            EXPECT_GT(changed, 1000u) << "nothing was blurred";
            EXPECT_LT(worst, 0.51 + stored.most / 512.0) << "beyond roundings of half floats";
            // An output of floats has the host's curve, too.
            const shader::Transfer encoding =
                motion_blur::encodingOf(transfer, VK_FORMAT_R16G16B16A16_SFLOAT);
            const image::Image encoded = draw(inputs);
            double off = 0.0;
            for (size_t i = 0; i < encoded.pixels.size(); ++i)
                if (i % 4 != 3)
                    off = std::max(
                        off,
                        std::abs(double(
                            encoded.pixels[i] - shader::valueOfLight(encoding, own.pixels[i])
                        ))
                    );
            EXPECT_LT(off, 0.003);
            inputs.isOff = true;
            inputs.blended = make(
                VK_FORMAT_R16G16B16A16_SFLOAT, std::vector<uint64_t>(kConventionPixels, 0)
            ); // which adds nothing, and so reads and writes all pixels
            const std::vector<std::byte> same = stored.bytes == 8
                                                    ? blurIntoBytes<uint64_t>(texels, inputs)
                                                    : blurIntoBytes<uint32_t>(texels, inputs);
            for (size_t i = 0; step == 1.0 && i < words.size(); ++i) {
                uint64_t word = 0;
                std::memcpy(&word, &same[i * stored.bytes], stored.bytes);
                ASSERT_EQ(stored.unpack(word), stored.unpack(words[i])) << i;
            }
        }
    }
}

/// A part of a larger image gets the picture, and what lies around stays.
TEST_F(EmbeddedConventions, APartOfAnImageOfBytesIsWrittenAlone) {
    const VkExtent2D whole{kConventionWidth + 24, kConventionHeight + 16};
    const VkRect2D area{{8, 6}, kConventionExtent};
    const auto inner = convert<uint32_t>(drawn.color, [](const glm::vec4& value) {
        return glm::packUnorm4x8(glm::clamp(value, 0.0f, 1.0f));
    });
    const std::vector<uint32_t> was = surround<uint32_t>(inner, 0x01020304u, whole, area.offset);
    HostInputs inputs = ownInputs();
    inputs.transfer.curve = shader::kTransferSrgb;
    const HostTexels& alone = makeTexels(VK_FORMAT_B8G8R8A8_UNORM, kConventionExtent, inner);
    inputs.color = alone.describe();
    const auto own = blurInto<uint32_t>(alone, inputs);
    const HostTexels& part = makeTexels(VK_FORMAT_B8G8R8A8_UNORM, whole, was);
    inputs.color = part.describe(area);
    EXPECT_EQ(
        blurInto<uint32_t>(part, inputs), (surround<uint32_t>(own, 0x01020304u, whole, area.offset))
    );
}

TEST_F(EmbeddedConventions, IdsInAStencilServeResolvedAlsoBesideTheDepthOfTheSameImage) {
    HostInputs inputs = movingCameraInputs();
    HostConvention& convention = inputs.convention;
    convention.vectors = {};
    convention.depth.isLinear = false;
    convention.depth.skyValue = 0.0f;
    const auto raw = convert<float>(drawn.metres, [](float metres) {
        return metres >= 1.0e9f ? 0.0f : kNear / metres;
    });
    const auto small = convert<uint8_t>(drawn.ids, [](uint32_t id) { return uint8_t(id); });
    const std::array<glm::dmat4, 2> poses{
        glm::translate(glm::dmat4(1.0), glm::dvec3(-0.4, 0.0, 0.0)), glm::dmat4(1.0)};
    const std::array<motion_blur::HostMover, 1> movers{{{7, poses}}};
    inputs.motion.rowCount = 201;
    inputs.motion.movers = movers;
    inputs.noEntity = 255;
    convention.depth.image = make(VK_FORMAT_D32_SFLOAT, raw);
    inputs.entityId = make(VK_FORMAT_R8_UINT, small);
    const MotionBlurSettings settings = test::settingsOf("resolved", 5);
    const image::Image own = draw(inputs, settings);

    for (const VkFormat format : {VK_FORMAT_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
        if (!canUse(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT))
            continue;
        SCOPED_TRACE(gpu::nameFormat(format));
        std::vector<std::byte> texels;
        if (format != VK_FORMAT_S8_UINT) {
            const auto depths = test::bytesOf(raw);
            texels.assign(depths.begin(), depths.end());
        }
        const auto ids = test::bytesOf(small);
        texels.insert(texels.end(), ids.begin(), ids.end());
        inputs.entityId = make(format, texels);
        EXPECT_TRUE(test::sameBits(draw(inputs, settings), own)) << "an image of its own";
        if (format == VK_FORMAT_S8_UINT)
            continue;
        convention.depth.image = inputs.entityId;
        EXPECT_TRUE(test::sameBits(draw(inputs, settings), own)) << "the image of depth";
        convention.depth.image.after = test::kSampled;
        test::expectRefusal(
            refuse(inputs, settings),
            "entityId.image is depth.image: format, extent, before and after"
        );
    }
    convention.depth.image.after = inputs.entityId.after;
    inputs.noEntity = 256;
    test::expectRefusal(
        refuse(inputs, settings), "noEntity is 256, but entityId holds values up to 255"
    );
}

TEST_F(EmbeddedConventions, SmallIdsServeResolved) {
    const MotionBlurSettings settings = test::settingsOf("resolved", 5);
    const motion_blur::HostCameraKey key{
        1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, 1.5, double(kNear))};
    const std::array<motion_blur::HostMover, 2> movers{{{7, {}}, {200, {}}}};
    HostInputs inputs = ownInputs();
    inputs.motion.keys = {&key, 1};
    inputs.motion.rowCount = 201;
    inputs.motion.movers = movers;
    inputs.entityId = make(VK_FORMAT_R32_UINT, drawn.ids);
    const image::Image own = draw(inputs, settings);
    ASSERT_FALSE(test::sameBits(own, draw(ownInputs())));
    inputs.noEntity = 255;
    inputs.entityId = make(VK_FORMAT_R8_UINT, convert<uint8_t>(drawn.ids, [](uint32_t id) {
                               return uint8_t(id);
                           }));
    EXPECT_TRUE(test::sameBits(draw(inputs, settings), own));
    inputs.noEntity = 0xFFFF;
    inputs.entityId = make(VK_FORMAT_R16_UINT, convert<uint16_t>(drawn.ids, [](uint32_t id) {
                               return uint16_t(id);
                           }));
    EXPECT_TRUE(test::sameBits(draw(inputs, settings), own));
}

TEST_F(EmbeddedConventions, VectorsOfASmallerPictureServeALargerOne) {
    const image::Image own = draw(ownInputs());
    std::vector<glm::vec2> vectors;
    std::vector<float> metres;
    for (uint32_t y = 0; y < kConventionHeight; y += 2) // all borders lie between such pixels
        for (uint32_t x = 0; x < kConventionWidth; x += 2) {
            vectors.push_back(drawn.motion[size_t{y} * kConventionWidth + x]);
            metres.push_back(drawn.metres[size_t{y} * kConventionWidth + x]);
        }
    constexpr VkExtent2D kHalf{kConventionWidth / 2, kConventionHeight / 2};
    HostInputs inputs = conventionInputs();
    inputs.convention.vectors.image =
        makeTexels(VK_FORMAT_R32G32_SFLOAT, kHalf, vectors).describe({{0, 0}, kHalf});
    // Without an area, all of its extent is used.
    inputs.convention.depth.image = make(VK_FORMAT_R32_SFLOAT, metres, kHalf);
    EXPECT_TRUE(test::sameBits(draw(inputs), own));
}

TEST_F(EmbeddedConventions, OnlyTheCameraMovesWithoutVectors) {
    HostInputs inputs = movingCameraInputs();
    HostConvention& convention = inputs.convention;
    const glm::vec2 still{0.0f};
    convention.vectors.image =
        make(VK_FORMAT_R32G32_SFLOAT, std::vector<glm::vec2>(kConventionPixels, still));
    convention.vectors.lackCamera = true;
    const image::Image zeros = draw(inputs);
    convention.vectors = {};
    EXPECT_TRUE(test::sameBits(draw(inputs), zeros));
    HostInputs cut = inputs;
    cut.convention.scales.isCut = true;
    const image::Image sharp = draw(cut);
    EXPECT_FALSE(test::sameBits(sharp, zeros)) << "nothing was blurred";
    // There is no camera before a cut, as in a host's first frame.
    cut.convention.cameras.viewFromWorldBefore = math::dmat4(0.0);
    cut.convention.cameras.clipFromViewBefore = math::dmat4(0.0);
    cut.convention.cameras.jitterPxBefore.x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(test::sameBits(draw(cut), sharp));
    // Without vectors their jitter flag is ignored.
    convention.cameras.jitterPx = {0.25, -0.25};
    convention.cameras.jitterPxBefore = {-0.25, 0.25};
    const image::Image jittered = draw(inputs);
    convention.vectors.haveJitter = true;
    EXPECT_TRUE(test::sameBits(draw(inputs), jittered));
}

TEST_F(EmbeddedConventions, AMethodThatFollowsTheCameraAloneReadsNoVectors) {
    HostInputs inputs = movingCameraInputs();
    HostConvention& convention = inputs.convention;
    const MotionBlurSettings settings = test::settingsOf("rosado2007");
    const image::Image own = draw(inputs, settings);
    const std::vector<glm::vec2> wrong(kConventionPixels, glm::vec2(3.0f, -8.0f));
    convention.vectors.image = make(VK_FORMAT_R32G32_SFLOAT, wrong);
    EXPECT_TRUE(test::sameBits(draw(inputs, settings), own));
    convention.cameras.viewFromWorldBefore = convention.cameras.viewFromWorld;
    EXPECT_FALSE(test::sameBits(draw(inputs, settings), own)) << "nothing was blurred";
}

TEST_F(EmbeddedConventions, ScalesOfTheMotionScaleTheBlur) {
    HostInputs half = conventionInputs();
    half.convention.scales.exposureShare = 0.5f;
    const image::Image own = draw(half);
    EXPECT_FALSE(test::sameBits(own, draw(conventionInputs())));
    HostInputs shares = conventionInputs();
    shares.convention.scales.perPixel =
        make(VK_FORMAT_R32_SFLOAT, std::vector<float>(kConventionPixels, 0.5f));
    EXPECT_TRUE(test::sameBits(draw(shares), own));
    // A weapon of the host's, held still in the picture.
    std::vector<uint8_t> kept(kConventionPixels, 255);
    for (size_t i = 0; i < kConventionPixels; ++i)
        if (drawn.ids[i] == 7)
            kept[i] = 0;
    HostInputs weapon = conventionInputs();
    weapon.convention.scales.perPixel = make(VK_FORMAT_R8_UNORM, kept);
    for (size_t i = 0; i < kConventionPixels; ++i)
        if (drawn.ids[i] == 7)
            drawn.motion[i] = {0.0f, 0.0f};
    EXPECT_TRUE(test::sameBits(draw(weapon), draw(ownInputs())));
}

/// A host without keys, of which two cameras and depth are all that it has.
TEST_F(EmbeddedConventions, TwoCamerasAreTwoKeysForResolved) {
    HostInputs inputs = movingCameraInputs();
    inputs.convention.vectors = {};
    const motion_blur::HostCameras& cameras = inputs.convention.cameras;
    const MotionBlurSettings settings = test::settingsOf("resolved", 5);
    const std::array<motion_blur::HostCameraKey, 2> keys{{
        {motion_blur::timeOfFrameBefore(inputs),
         cameras.viewFromWorldBefore,
         cameras.clipFromViewBefore},
        {1.0, cameras.viewFromWorld, cameras.clipFromView},
    }};
    HostInputs withKeys = inputs;
    withKeys.motion.keys = keys;
    const image::Image own = draw(withKeys, settings);
    EXPECT_TRUE(test::sameBits(draw(inputs, settings), own));
    MotionBlurSettings byDefault;
    byDefault.sampleCount = 5;
    EXPECT_TRUE(test::sameBits(draw(inputs, byDefault), own)) << "resolved is the default then";
    HostInputs cut = inputs;
    cut.convention.scales.isCut = true;
    cut.convention.cameras.viewFromWorldBefore = math::dmat4(0.0);
    const image::Image sharp = draw(cut, settings);
    EXPECT_FALSE(test::sameBits(sharp, own));
    // The raster's jitter is in both keys, so that all but the border's rounding is the same.
    inputs.convention.cameras.jitterPx = {0.25, -0.25};
    expectNear(draw(inputs, settings), own, 30.0);
    // Vectors alone say how objects move: then the default is gather.
    HostInputs withVectors = movingCameraInputs();
    EXPECT_TRUE(test::sameBits(draw(withVectors, {}), draw(withVectors, test::settingsOf("gather")))
    );
}

TEST_F(EmbeddedConventions, ACameraThatJumpsFartherThanTheHostAllowsIsACut) {
    HostInputs inputs = movingCameraInputs(); // by half a metre
    inputs.convention.vectors = {};
    motion_blur::HostCameras& cameras = inputs.convention.cameras;
    const math::dmat4 moved = cameras.viewFromWorldBefore;
    HostInputs cut = inputs;
    cut.convention.scales.isCut = true;
    for (const MotionBlurSettings& settings : {test::settingsOf("resolved", 5), test::gather()}) {
        const image::Image blurred = draw(inputs, settings);
        const image::Image sharp = draw(cut, settings);
        ASSERT_FALSE(test::sameBits(blurred, sharp));
        cameras.cutDistance = 0.6;
        EXPECT_TRUE(test::sameBits(draw(inputs, settings), blurred));
        cameras.cutDistance = 0.4;
        EXPECT_TRUE(test::sameBits(draw(inputs, settings), sharp));
        cameras.cutDistance = 0.0;
    }
    cameras.viewFromWorldBefore = glm::rotate(math::dmat4(1.0), 0.1, math::dvec3(0, 1, 0));
    cameras.cutDegrees = 5.0;
    EXPECT_TRUE(test::sameBits(draw(inputs), draw(cut)));
    cameras.cutDegrees = 6.0;
    EXPECT_FALSE(test::sameBits(draw(inputs), draw(cut)));
    // About the direction of view, too.
    cameras.viewFromWorldBefore = glm::rotate(math::dmat4(1.0), 0.2, math::dvec3(0, 0, 1));
    EXPECT_TRUE(test::sameBits(draw(inputs), draw(cut)));
    cameras.viewFromWorldBefore = moved;
}

TEST_F(EmbeddedConventions, ScalesOfTheMotionScaleTheKeysOfResolved) {
    HostInputs inputs = movingCameraInputs();
    inputs.convention.vectors = {};
    const MotionBlurSettings settings = test::settingsOf("resolved", 5);
    HostInputs half = inputs;
    half.convention.scales.exposureShare = 0.5f;
    const image::Image own = draw(half, settings);
    EXPECT_LT(image::computePsnr(draw(inputs, settings), own), 45.0);
    half = inputs;
    half.convention.scales.camera = 0.5f;
    expectNear(draw(half, settings), own, 70.0);
    HostInputs none = inputs;
    none.convention.scales.camera = 0.0f;
    HostInputs cut = inputs;
    cut.convention.scales.isCut = true;
    EXPECT_TRUE(test::sameBits(draw(none, settings), draw(cut, settings)));

    // A mover: its own motion has a scale of its own.
    const math::dmat4 unit(1.0);
    const std::array<math::dmat4, 2> moved{glm::translate(unit, math::dvec3(-0.4, 0.0, 0.0)), unit};
    const motion_blur::HostMover mover{7, moved};
    none.motion.movers = {&mover, 1};
    none.motion.rowCount = 201;
    none.entityId = make(VK_FORMAT_R32_UINT, drawn.ids);
    EXPECT_FALSE(test::sameBits(draw(none, settings), draw(cut, settings)));
    none.convention.scales.object = 0.0f;
    EXPECT_TRUE(test::sameBits(draw(none, settings), draw(cut, settings)));
}

TEST_F(EmbeddedConventions, AViewModelIsSharpBeforeABlurredBackground) {
    HostInputs inputs = movingCameraInputs();
    inputs.convention.vectors = {};
    const MotionBlurSettings settings = test::settingsOf("resolved", 5);
    const std::array<uint32_t, 1> rows{7};
    inputs.entityId = make(VK_FORMAT_R32_UINT, drawn.ids);
    inputs.motion.rowCount = 201;
    const image::Image blurred = draw(inputs, settings);
    inputs.motion.viewModelRows = rows;
    const image::Image made = draw(inputs, settings);
    size_t sharp = 0;
    size_t wasSharp = 0;
    size_t blurredPixels = 0;
    for (size_t i = 0; i < kConventionPixels; ++i) {
        const auto differs = [&](const image::Image& picture) {
            return std::memcmp(&picture.pixels[4 * i], &drawn.color[i], 3 * sizeof(float)) != 0;
        };
        if (drawn.ids[i] == 7) {
            sharp += !differs(made);
            wasSharp += !differs(blurred);
        } else {
            blurredPixels += differs(made);
        }
    }
    EXPECT_EQ(sharp, 30u * 30u);
    EXPECT_LT(wasSharp, 30u * 30u);
    EXPECT_GT(blurredPixels, kConventionPixels / 4);

    // By its depth, with ids that do not know it, and without any.
    HostInputs byDepth = inputs;
    byDepth.motion.viewModelRows = {};
    byDepth.convention.viewModel.depthMin = byDepth.convention.viewModel.depthMax = 2.0f;
    byDepth.entityId = make(VK_FORMAT_R32_UINT, convert<uint32_t>(drawn.ids, [](uint32_t id) {
                                return id == 7 ? 1 : id;
                            }));
    EXPECT_TRUE(test::sameBits(draw(byDepth, settings), made));
    // A row that the host does not have is not the view model's.
    const auto drawOther = [&](uint32_t row) {
        byDepth.entityId = make(VK_FORMAT_R32_UINT, convert<uint32_t>(drawn.ids, [&](uint32_t id) {
                                    return id == 200 ? row : id;
                                }));
        return draw(byDepth, settings);
    };
    EXPECT_TRUE(test::sameBits(drawOther(201), drawOther(5000)));
    byDepth.entityId = {}; // the boxes beside it are one with the wall then, to rounding
    expectNear(draw(byDepth, settings), made, 60.0);
    // Filters follow no camera there, either: without vectors it is as sharp as with a scale of 0.
    HostInputs scaled = byDepth;
    scaled.convention.viewModel = {};
    scaled.convention.scales.perPixel =
        make(VK_FORMAT_R32_SFLOAT, convert<float>(drawn.ids, [](uint32_t id) {
                 return id == 7 ? 0.0f : 1.0f;
             }));
    EXPECT_TRUE(test::sameBits(draw(byDepth), draw(scaled)));
    // Its own motion blurs it.
    const std::array<glm::dmat4, 2> poses{
        glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 0.0, 0.0)), glm::dmat4(1.0)};
    byDepth.convention.viewModel.viewFromObject = poses;
    const image::Image moving = draw(byDepth, settings);
    EXPECT_FALSE(test::sameBits(moving, made));
    HostInputs cut = byDepth;
    cut.convention.scales.isCut = true;
    HostInputs plainCut = cut;
    plainCut.convention.viewModel = {};
    EXPECT_TRUE(test::sameBits(draw(cut, settings), draw(plainCut, settings)));
    byDepth.convention.viewModel.viewFromObject = std::span(&poses[0], 1);
    test::expectRefusal(refuse(byDepth, settings), "viewModel.viewFromObject holds 1, keys 2");
}

/// HostInputs::showsInputs: panels cover a part of the picture, and of nothing else. The left half
/// moves by itself; the camera is static.
class EmbeddedOverlay : public EmbeddedConventions {
  protected:
    void SetUp() override {
        EmbeddedConventions::SetUp();
        for (size_t i = 0; i < kConventionPixels; ++i) {
            const bool isLeft = i % kConventionWidth < kConventionWidth / 2;
            drawn.color[i] = {0.25f, 0.5f, 0.75f, 1.0f};
            drawn.motion[i] = {isLeft ? 12.0f : 0.0f, 0.0f};
            drawn.metres[i] = 5.0f;
            drawn.ids[i] = isLeft ? 3 : 0xFFFFFFFF;
        }
    }

    HostInputs describe() {
        HostInputs inputs = conventionInputs();
        inputs.entityId = make(VK_FORMAT_R32_UINT, drawn.ids);
        inputs.observe = [this](graph::Graph& graph, const auto&, const auto&) {
            mPasses.clear();
            for (const graph::PassRecord& pass : graph.passes())
                mPasses.insert(pass.name);
        };
        return inputs;
    }

    static void giveCameras(HostInputs& inputs) {
        auto& cameras = inputs.convention.cameras;
        cameras.areGiven = true;
        cameras.clipFromView = cameras.clipFromViewBefore =
            math::clipFromViewPerspective(1.0, 1.5, 0.1);
    }

    /// Which panels differ from a picture without any; kPanelCount: what no panel covers.
    static std::set<uint32_t> findChanged(const image::Image& with, const image::Image& without) {
        std::set<uint32_t> changed;
        for (uint32_t i = 0; i < kConventionPixels; ++i)
            for (uint32_t channel = 0; channel < with.channels; ++channel)
                if (with.pixels[i * with.channels + channel] !=
                    without.pixels[i * with.channels + channel])
                    changed.insert(shader::panelAt(
                        {i % kConventionWidth, i / kConventionWidth},
                        {kConventionWidth, kConventionHeight}
                    ));
        return changed;
    }

    std::set<std::string> mPasses;
};

TEST_F(EmbeddedOverlay, OnlyPanelsWithInputsAreDrawn) {
    HostInputs inputs = describe();
    const image::Image without = draw(inputs);
    EXPECT_FALSE(mPasses.contains("show inputs"));
    inputs.showsInputs = true;
    EXPECT_EQ(
        findChanged(draw(inputs), without),
        (std::set<uint32_t>{shader::kPanelMotion, shader::kPanelDepth, shader::kPanelIds})
    );
    giveCameras(inputs);
    EXPECT_EQ(
        findChanged(draw(inputs), without),
        (std::set<uint32_t>{
            shader::kPanelMotion,
            shader::kPanelCamera,
            shader::kPanelObjects,
            shader::kPanelDepth,
            shader::kPanelWorld,
            shader::kPanelIds,
            shader::kPanelJitter})
    );
    inputs.showsInputs = false;
    EXPECT_TRUE(test::sameBits(draw(inputs), without));
    inputs.showsInputs = true;
    inputs.isOff = true;
    (void)draw(inputs); // a copy of the colours
}

} // namespace
} // namespace shutter
