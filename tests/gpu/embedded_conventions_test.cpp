// SPDX-License-Identifier: MIT
// A host may bring its images in other formats, conventions and places than the motion blur's own:
// the picture is the same, to the bit where nothing is rounded on the way.
#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/image/metrics.h"
#include "engine/math/transform.h"
#include "tests/gpu/embedding_host.h"
#include "tests/gpu/host_texels.h"
#include "tests/support/picture.h"

#include <glm/gtc/packing.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace shutter {
namespace {

using motion_blur::HostConvention;
using motion_blur::HostImage;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using test::bytesOf;
using test::HostTexels;
using test::kCopied;
using test::kSampled;
using test::kWritten;
using test::moveOn;
using test::packHalf;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;
constexpr float kNear = 0.125f;
constexpr size_t kPixels = size_t{kWidth} * kHeight;

/// What a host drew, in main memory: rectangles before a wall, and sky above it.
struct Drawn {
    std::vector<glm::vec4> color{kPixels};
    std::vector<glm::vec2> motion{
        kPixels}; ///< pixels over the exposure; quarters, halves hold them
    std::vector<float> metres = std::vector<float>(kPixels);
    std::vector<uint32_t> ids = std::vector<uint32_t>(kPixels);
};

Drawn draw() {
    Drawn drawn;
    std::mt19937 random(5);
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const size_t at = size_t{y} * kWidth + x;
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
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x)
            texels[size_t{y + uint32_t(at.y)} * whole.width + x + uint32_t(at.x)] =
                inner[size_t{y} * kWidth + x];
    return texels;
}

class EmbeddedConventions : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        mBlur = create(describeHost());
        drawn = draw();
    }

    void TearDown() override {
        mTexels.clear();
        mBlur.reset();
        EmbeddedTest::TearDown();
    }

    template <class T>
    const HostTexels&
    make(VkFormat format, const std::vector<T>& values, VkExtent2D extent = {kWidth, kHeight}) {
        return mTexels.emplace_back(device(), format, extent, bytesOf(values));
    }

    /// Whether images of the format may be used so.
    static bool canUse(VkFormat format, VkFormatFeatureFlags features) {
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(device().physical(), format, &properties);
        return (properties.optimalTilingFeatures & features) == features;
    }

    HostImage color() {
        return make(VK_FORMAT_R16G16B16A16_SFLOAT, convert<uint64_t>(drawn.color, packHalf))
            .describe();
    }

    HostImage ownMotionDepth() {
        std::vector<glm::vec4> texels;
        for (size_t i = 0; i < kPixels; ++i)
            texels.emplace_back(drawn.motion[i], drawn.metres[i], 0.0f);
        return make(VK_FORMAT_R32G32B32A32_SFLOAT, texels).describe();
    }

    HostInputs ownInputs() {
        HostInputs inputs;
        inputs.width = kWidth;
        inputs.height = kHeight;
        inputs.color = color();
        inputs.motionDepth = ownMotionDepth();
        return inputs;
    }

    /// The same in a convention that rounds nothing.
    HostInputs conventionInputs() {
        HostInputs inputs = ownInputs();
        inputs.motionDepth = {};
        HostConvention& convention = inputs.convention;
        convention.vectors.image = make(VK_FORMAT_R32G32_SFLOAT, drawn.motion).describe();
        convention.depth.image = make(VK_FORMAT_R32_SFLOAT, drawn.metres).describe();
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

    /// Runs the effect, and what is recorded behind it.
    void
    run(const HostInputs& inputs,
        const MotionBlurSettings& settings,
        const std::function<void(VkCommandBuffer)>& behind) {
        gpu::Frame frame(device());
        frame.begin();
        for (const HostTexels& texels : mTexels)
            texels.record(frame.commands());
        const core::Status done = mBlur->record(frame.commands(), 0, inputs, settings);
        EXPECT_TRUE(done.ok()) << done.error().message;
        if (done)
            behind(frame.commands());
        frame.submit();
        frame.wait();
    }

    /// Draws into an image of the picture's size.
    image::Image blur(HostInputs inputs, const MotionBlurSettings& settings = test::gather()) {
        const test::Picture output(device(), "output", {kWidth, kHeight});
        inputs.output = {output.handle(), test::kNothing, kCopied};
        run(inputs, settings, [&](VkCommandBuffer commands) { output.recordReadback(commands); });
        return output.read();
    }

    /// Draws with `inputs` as they are, and reads what `target` holds then.
    template <class T> std::vector<T> blurInto(const HostTexels& target, const HostInputs& inputs) {
        const VkExtent2D extent = target.extent();
        const size_t count = size_t{extent.width} * extent.height;
        const gpu::Buffer copy(device(), "copy", count * sizeof(T), 0, gpu::MemoryUse::Readback);
        run(inputs, test::gather(), [&](VkCommandBuffer commands) {
            test::copyToBuffer(commands, target.image(), copy);
        });
        std::vector<T> texels(count);
        std::memcpy(texels.data(), copy.mapped(), count * sizeof(T));
        return texels;
    }

    /// The part of `target` that the picture belongs to holds it, the rest what was there.
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
            if (x >= kWidth || y >= kHeight) {
                wrong += texels[i] != was[i];
                continue;
            }
            const glm::vec4 value = glm::unpackHalf4x16(texels[i]);
            wrong +=
                std::memcmp(&value, &own.pixels[4 * (size_t{y} * kWidth + x)], sizeof(value)) != 0;
        }
        EXPECT_EQ(wrong, 0u);
    }

    Drawn drawn;
    std::unique_ptr<motion_blur::EmbeddedMotionBlur> mBlur;
    std::deque<HostTexels> mTexels;
};

void expectNear(const image::Image& made, const image::Image& own, double psnrDb) {
    EXPECT_TRUE(test::allFinite(made));
    EXPECT_GT(image::computePsnr(made, own), psnrDb);
}

TEST_F(EmbeddedConventions, VectorsAndDepthApartGiveTheSameBits) {
    const image::Image own = blur(ownInputs());
    EXPECT_TRUE(test::sameBits(blur(conventionInputs()), own));
    EXPECT_FALSE(test::sameBits(
        own,
        [&] {
            HostInputs cut = conventionInputs();
            cut.convention.scales.isCut = true;
            return blur(cut);
        }()
    )) << "nothing was blurred";
}

TEST_F(EmbeddedConventions, EachFormatOfVectorsAndEachSignIsTheSamePicture) {
    const image::Image own = blur(ownInputs());

    struct Case {
        std::string name;
        glm::vec2 pixelsPerUnit;
    };

    for (const Case& one : std::vector<Case>{
             {"pixels, before to now", {1.0f, 1.0f}},
             {"texture coordinates, now to before", {-float(kWidth), -float(kHeight)}},
             {"normalised coordinates, y up", {-0.5f * kWidth, 0.5f * kHeight}}}) {
        SCOPED_TRACE(one.name);
        const auto vectors = convert<glm::vec2>(drawn.motion, [&](const glm::vec2& motion) {
            return motion / one.pixelsPerUnit;
        });
        const auto wide = convert<glm::vec4>(vectors, [](const glm::vec2& value) {
            return glm::vec4(value, 99.0f, -5.0f); // the other channels are the host's own affair
        });
        HostInputs inputs = conventionInputs();
        inputs.convention.vectors.pixelsPerUnit = one.pixelsPerUnit;
        inputs.convention.vectors.image = make(VK_FORMAT_R32G32_SFLOAT, vectors).describe();
        expectNear(blur(inputs), own, 70.0);
        inputs.convention.vectors.image = make(VK_FORMAT_R32G32B32A32_SFLOAT, wide).describe();
        expectNear(blur(inputs), own, 70.0);
        inputs.convention.vectors.image =
            make(VK_FORMAT_R16G16B16A16_SFLOAT, convert<uint64_t>(wide, packHalf)).describe();
        expectNear(blur(inputs), own, 50.0);
        inputs.convention.vectors.image =
            make(
                VK_FORMAT_R16G16_SFLOAT,
                convert<uint32_t>(
                    vectors, [](const glm::vec2& value) { return glm::packHalf2x16(value); }
                )
            ).describe();
        expectNear(blur(inputs), own, 50.0);
    }
}

TEST_F(EmbeddedConventions, EachFormatOfDepthIsTheSamePicture) {
    const image::Image own = blur(ownInputs());
    // Powers of two: near / metres is exact.
    const auto raw = convert<float>(drawn.metres, [](float metres) {
        return metres < 1.0e9f ? kNear / metres : 0.0f;
    });
    HostInputs inputs = conventionInputs();
    useReversedInfiniteCamera(inputs.convention);
    for (const VkFormat format :
         {VK_FORMAT_D32_SFLOAT, VK_FORMAT_R32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT}) {
        SCOPED_TRACE(gpu::nameFormat(format));
        inputs.convention.depth.image = make(format, raw).describe();
        EXPECT_TRUE(test::sameBits(blur(inputs), own));
    }
    inputs.convention.depth.image =
        make(
            VK_FORMAT_D16_UNORM,
            convert<uint16_t>(raw, [](float value) { return uint16_t(value * 65535.0f + 0.5f); })
        ).describe();
    expectNear(blur(inputs), own, 60.0);
}

TEST_F(EmbeddedConventions, PartsOfLargerImagesGiveTheSameBitsAndTouchNothingElse) {
    const image::Image own = blur(ownInputs());
    constexpr VkExtent2D kWhole{kWidth + 37, kHeight + 21};
    constexpr VkRect2D kArea{{29, 13}, {kWidth, kHeight}};
    const auto halves = convert<uint64_t>(drawn.color, packHalf);
    const uint64_t bright = packHalf(glm::vec4(900.0f));
    HostInputs inputs = conventionInputs();
    inputs.color =
        make(VK_FORMAT_R16G16B16A16_SFLOAT, surround(halves, bright, kWhole, kArea.offset), kWhole)
            .describe(kArea);
    inputs.convention.vectors.image =
        make(
            VK_FORMAT_R32G32_SFLOAT,
            surround(drawn.motion, glm::vec2(30.0f), kWhole, kArea.offset),
            kWhole
        )
            .describe(kArea);
    inputs.convention.depth.image =
        make(VK_FORMAT_R32_SFLOAT, surround(drawn.metres, 0.5f, kWhole, kArea.offset), kWhole)
            .describe(kArea);
    EXPECT_TRUE(test::sameBits(blur(inputs), own));

    const std::vector<uint64_t> blank(size_t{kWhole.width} * kWhole.height, bright);
    const HostTexels& target = mTexels.emplace_back(
        device(), VK_FORMAT_R16G16B16A16_SFLOAT, kWhole, bytesOf(blank), VK_IMAGE_USAGE_STORAGE_BIT
    );
    inputs.output = target.describe(kArea);
    expectPart(target, inputs, kArea, blank, own);
    // In place, too.
    const auto whole = surround(halves, bright, kWhole, kArea.offset);
    const HostTexels& colors = mTexels.emplace_back(
        device(), VK_FORMAT_R16G16B16A16_SFLOAT, kWhole, bytesOf(whole), VK_IMAGE_USAGE_STORAGE_BIT
    );
    inputs.color = colors.describe(kArea);
    inputs.output = {};
    expectPart(colors, inputs, kArea, whole, own);
}

TEST_F(EmbeddedConventions, ColoursOfOtherFormatsAreBlurredAlike) {
    const image::Image own = blur(ownInputs());
    HostInputs inputs = ownInputs();
    const HostTexels& wide = mTexels.emplace_back(
        device(),
        VK_FORMAT_R32G32B32A32_SFLOAT,
        VkExtent2D{kWidth, kHeight},
        bytesOf(drawn.color),
        VK_IMAGE_USAGE_STORAGE_BIT
    );
    inputs.color = wide.describe();
    EXPECT_TRUE(test::sameBits(blur(inputs), own));
    const auto inPlace = blurInto<glm::vec4>(wide, inputs);
    EXPECT_EQ(std::memcmp(inPlace.data(), own.pixels.data(), kPixels * sizeof(glm::vec4)), 0);

    constexpr VkFormat kPacked = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    if (!canUse(kPacked, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT))
        GTEST_SKIP() << "the device stores no B10G11R11";
    const auto packed = convert<uint32_t>(drawn.color, [](const glm::vec4& value) {
        return glm::packF2x11_1x10(glm::vec3(value));
    });
    const HostTexels& small = mTexels.emplace_back(
        device(), kPacked, VkExtent2D{kWidth, kHeight}, bytesOf(packed), VK_IMAGE_USAGE_STORAGE_BIT
    );
    inputs.color = small.describe();
    EXPECT_TRUE(test::sameBits(blur(inputs), own));
    const auto stored = blurInto<uint32_t>(small, inputs);
    size_t wrong = 0;
    for (size_t i = 0; i < kPixels; ++i) {
        const glm::vec3 value = glm::unpackF2x11_1x10(stored[i]);
        for (int channel = 0; channel < 3; ++channel) {
            const float wanted = own.pixels[4 * i + channel];
            wrong += std::abs(value[channel] - wanted) > wanted / 32.0f + 1.0e-4f; // blue: 5 bits
        }
    }
    EXPECT_EQ(wrong, 0u);
}

TEST_F(EmbeddedConventions, SmallIdsServeResolved) {
    MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("resolved");
    settings.sampleCount = 5;
    const motion_blur::HostCameraKey key{
        1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, 1.5, double(kNear))};
    const std::array<motion_blur::HostMover, 2> movers{{{7, {}}, {200, {}}}};
    HostInputs inputs = ownInputs();
    inputs.motion.keys = {&key, 1};
    inputs.motion.rowCount = 201;
    inputs.motion.movers = movers;
    inputs.entityId = make(VK_FORMAT_R32_UINT, drawn.ids).describe();
    const image::Image own = blur(inputs, settings);
    ASSERT_FALSE(test::sameBits(own, blur(ownInputs())));
    inputs.noEntity = 255;
    inputs.entityId =
        make(
            VK_FORMAT_R8_UINT, convert<uint8_t>(drawn.ids, [](uint32_t id) { return uint8_t(id); })
        ).describe();
    EXPECT_TRUE(test::sameBits(blur(inputs, settings), own));
    inputs.noEntity = 0xFFFF;
    inputs.entityId = make(
                          VK_FORMAT_R16_UINT,
                          convert<uint16_t>(drawn.ids, [](uint32_t id) { return uint16_t(id); })
    ).describe();
    EXPECT_TRUE(test::sameBits(blur(inputs, settings), own));
}

TEST_F(EmbeddedConventions, VectorsOfASmallerPictureServeALargerOne) {
    const image::Image own = blur(ownInputs());
    std::vector<glm::vec2> vectors;
    std::vector<float> metres;
    for (uint32_t y = 0; y < kHeight; y += 2) // all borders lie between such pixels
        for (uint32_t x = 0; x < kWidth; x += 2) {
            vectors.push_back(drawn.motion[size_t{y} * kWidth + x]);
            metres.push_back(drawn.metres[size_t{y} * kWidth + x]);
        }
    constexpr VkExtent2D kHalf{kWidth / 2, kHeight / 2};
    HostInputs inputs = conventionInputs();
    inputs.convention.vectors.image =
        make(VK_FORMAT_R32G32_SFLOAT, vectors, kHalf).describe({{0, 0}, kHalf});
    // All of its extent is used, where no area is said.
    inputs.convention.depth.image = make(VK_FORMAT_R32_SFLOAT, metres, kHalf).describe();
    EXPECT_TRUE(test::sameBits(blur(inputs), own));
}

TEST_F(EmbeddedConventions, WithoutAnAreaTheRestOfTheExtentIsUsed) {
    const image::Image own = blur(ownInputs());
    constexpr VkExtent2D kWhole{kWidth + 24, kHeight + 10};
    constexpr VkOffset2D kAt{24, 10};
    HostInputs inputs = conventionInputs();
    inputs.convention.vectors.image =
        make(VK_FORMAT_R32G32_SFLOAT, surround(drawn.motion, glm::vec2(99.0f), kWhole, kAt), kWhole)
            .describe({kAt, {0, 0}});
    inputs.convention.depth.image =
        make(VK_FORMAT_R32_SFLOAT, surround(drawn.metres, 0.01f, kWhole, kAt), kWhole)
            .describe({kAt, {0, 0}});
    EXPECT_TRUE(test::sameBits(blur(inputs), own));
}

TEST_F(EmbeddedConventions, WithoutVectorsTheCameraAloneMoves) {
    HostInputs inputs = movingCameraInputs();
    HostConvention& convention = inputs.convention;
    const glm::vec2 still{0.0f};
    convention.vectors.image =
        make(VK_FORMAT_R32G32_SFLOAT, std::vector<glm::vec2>(kPixels, still)).describe();
    convention.vectors.lackCamera = true;
    const image::Image zeros = blur(inputs);
    convention.vectors = {};
    EXPECT_TRUE(test::sameBits(blur(inputs), zeros));
    HostInputs cut = inputs;
    cut.convention.scales.isCut = true;
    const image::Image sharp = blur(cut);
    EXPECT_FALSE(test::sameBits(sharp, zeros)) << "nothing was blurred";
    // There is no camera before a cut, as in a host's first frame.
    cut.convention.cameras.viewFromWorldBefore = math::dmat4(0.0);
    cut.convention.cameras.clipFromViewBefore = math::dmat4(0.0);
    cut.convention.cameras.jitterPxBefore.x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(test::sameBits(blur(cut), sharp));
    // No vectors hold no jitter, whatever is said of them.
    convention.cameras.jitterPx = {0.25, -0.25};
    convention.cameras.jitterPxBefore = {-0.25, 0.25};
    const image::Image jittered = blur(inputs);
    convention.vectors.haveJitter = true;
    EXPECT_TRUE(test::sameBits(blur(inputs), jittered));
}

TEST_F(EmbeddedConventions, AMethodThatFollowsTheCameraAloneReadsNoVectors) {
    HostInputs inputs = movingCameraInputs();
    HostConvention& convention = inputs.convention;
    MotionBlurSettings settings = test::gather();
    settings.method = &motion_blur::getMethod("rosado2007");
    const image::Image own = blur(inputs, settings);
    const std::vector<glm::vec2> wrong(kPixels, glm::vec2(3.0f, -8.0f));
    convention.vectors.image = make(VK_FORMAT_R32G32_SFLOAT, wrong).describe();
    EXPECT_TRUE(test::sameBits(blur(inputs, settings), own));
    convention.cameras.viewFromWorldBefore = convention.cameras.viewFromWorld;
    EXPECT_FALSE(test::sameBits(blur(inputs, settings), own)) << "nothing was blurred";
}

TEST_F(EmbeddedConventions, MoversWithNeitherVectorsNorMatricesAreRefused) {
    HostInputs inputs = conventionInputs();
    const test::Picture output(device(), "output", {kWidth, kHeight});
    inputs.output = {output.handle(), test::kNothing, kCopied};
    inputs.entityId = make(VK_FORMAT_R32_UINT, drawn.ids).describe();
    useReversedInfiniteCamera(inputs.convention);
    inputs.convention.vectors = {};
    const motion_blur::HostCameraKey key{
        1.0, math::dmat4(1.0), inputs.convention.cameras.clipFromView};
    const std::array matrices{math::dmat4(1.0)};
    const std::array<motion_blur::HostMover, 2> movers{{{7, matrices}, {200, {}}}};
    inputs.motion.keys = {&key, 1};
    inputs.motion.rowCount = 201;
    inputs.motion.movers = movers;
    MotionBlurSettings settings = test::gather();
    settings.method = &motion_blur::getMethod("resolved");
    gpu::Frame frame(device());
    frame.begin();
    const core::Status done = mBlur->record(frame.commands(), 0, inputs, settings);
    frame.submit();
    frame.wait();
    ASSERT_FALSE(done.ok());
    EXPECT_EQ(
        done.error().message,
        "motion blur: movers[1] has no worldFromObject, and vectors.image "
        "is "
        "null: without vectors each mover needs matrices"
    );
}

TEST_F(EmbeddedConventions, SharesOfTheMotionAreBlurred) {
    HostInputs half = conventionInputs();
    half.convention.scales.exposureShare = 0.5f;
    const image::Image own = blur(half);
    EXPECT_FALSE(test::sameBits(own, blur(conventionInputs())));
    HostInputs generated = conventionInputs();
    generated.convention.scales.displayedPerRendered = 2.0f;
    EXPECT_TRUE(test::sameBits(blur(generated), own));
    HostInputs shares = conventionInputs();
    shares.convention.scales.perPixel =
        make(VK_FORMAT_R32_SFLOAT, std::vector<float>(kPixels, 0.5f)).describe();
    EXPECT_TRUE(test::sameBits(blur(shares), own));
    // A weapon of the host's, held still in the picture.
    std::vector<uint8_t> kept(kPixels, 255);
    for (size_t i = 0; i < kPixels; ++i)
        if (drawn.ids[i] == 7)
            kept[i] = 0;
    HostInputs weapon = conventionInputs();
    weapon.convention.scales.perPixel = make(VK_FORMAT_R8_UNORM, kept).describe();
    for (size_t i = 0; i < kPixels; ++i)
        if (drawn.ids[i] == 7)
            drawn.motion[i] = {0.0f, 0.0f};
    EXPECT_TRUE(test::sameBits(blur(weapon), blur(ownInputs())));
}

} // namespace
} // namespace shutter
