// SPDX-License-Identifier: MIT
// Transparent surfaces of a host, which go over the blurred picture: as an image of the whole
// exposure, or drawn by the host at instants against the depths that the method saw.
#include "spirv/draw_blended.comp.h"

#include "engine/image/metrics.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/math/transform.h"
#include "game/replay/replay_run.h"
#include "modules/motion_blur/embedding/host_blended.h"
#include "tests/gpu/c_inputs.h"
#include "tests/gpu/embedding_host.h"
#include "tests/support/picture.h"
#include "tests/support/temp_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shutter {
namespace {

using math::vec4;
using motion_blur::BlendedTask;
using motion_blur::HostCameraKey;
using motion_blur::HostImage;
using motion_blur::HostInputs;
using motion_blur::HostMover;
using motion_blur::MotionBlurSettings;
using test::HostTexels;

constexpr VkExtent2D kBlendedSize{128, 48};
constexpr int kBlendedInstants = 15;
constexpr double kRasterTime = 0.5;
constexpr vec4 kPane{0.1f, 0.9f, 0.3f, 0.5f}; // of draw_blended.comp

/// Left edge of a square before a striped wall, in pixels; the pane of draw_blended.comp meets
/// it.
double squareAt(double time) {
    return 30.0 + 36.0 * time;
}

bool isSquare(uint32_t x, uint32_t y, double time) {
    const double in = x + 0.5 - squareAt(time);
    return in >= 0.0 && in < 24.0 && y >= 12 && y < 36;
}

vec4 colorAt(uint32_t x, uint32_t y, double time) {
    if (isSquare(x, y, time))
        return {0.9f, 0.2f, 0.1f, 1.0f};
    // Stripes along the square's path: uncovered parts are visible next to it.
    return y / 8 % 2 == 0 ? vec4(0.6f, 0.6f, 0.7f, 1.0f) : vec4(0.1f, 0.1f, 0.3f, 1.0f);
}

/// The share of light that the pane takes, by its instant's place and the surfaces in front of it.
float paneAt(uint32_t x, uint32_t y, double time) {
    const double in = x + 0.5 - (70.0 - 30.0 * time);
    const bool isSeen = in >= 0.0 && in < 32.0 && y >= 8 && y < 40;
    return isSeen && (y < 24 || !isSquare(x, y, time)) ? kPane.a : 0.0f;
}

image::Image makeTruth(bool hasPane = true) {
    image::Image truth(kBlendedSize.width, kBlendedSize.height, 4);
    for (uint32_t y = 0; y < kBlendedSize.height; ++y)
        for (uint32_t x = 0; x < kBlendedSize.width; ++x)
            for (int i = 0; i < kBlendedInstants; ++i) {
                const double time = (i + 0.5) / kBlendedInstants;
                const float opacity = hasPane ? paneAt(x, y, time) : 0.0f;
                for (int channel = 0; channel < 4; ++channel) {
                    const float pane = channel < 3 ? kPane[channel] : 1.0f;
                    const float behind = colorAt(x, y, time)[channel];
                    truth.pixels[4 * (size_t{y} * kBlendedSize.width + x) + size_t(channel)] +=
                        (opacity * pane + (1.0f - opacity) * behind) / kBlendedInstants;
                }
            }
    return truth;
}

/// Draws the pane by a compute shader of the host's.
class PaneHost {
  public:
    explicit PaneHost(gpu::Device& device) : mDevice(device) {
        gpu::ComputePipelineDesc desc;
        desc.name = "the host's pane";
        desc.spirv = draw_blended_comp;
        desc.interface.bindings = {
            VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
            VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
        desc.interface.pushConstantBytes = sizeof(Push);
        mPipeline.emplace(device, desc);
        mNothing = gpu::Buffer(
            device, "nothing", 32, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Device
        );
    }

    void draw(const BlendedTask& task) {
        tasks.push_back(task);
        times.assign(task.times, task.times + task.instantCount);
        ASSERT_EQ(task.structBytes, sizeof(task));
        ASSERT_LE(task.firstInstant + task.partInstantCount, task.instantCount);
        ASSERT_LE(task.partInstantCount, 16u);
        Push push{};
        push.sizePx = {task.area.extent.width, task.area.extent.height};
        push.originPx = {task.area.offset.x, task.area.offset.y};
        push.firstInstant = task.firstInstant;
        push.partInstantCount = task.partInstantCount;
        push.instantCount = task.instantCount;
        push.hasSurfaces = task.surfaces ? 1 : 0;
        push.isOpacityInAlpha = task.opacity.image ? 0 : 1;
        for (uint32_t i = 0; i < task.partInstantCount; ++i)
            push.times[i] = float(task.times[task.firstInstant + i]);
        const auto adopt = [&](VkImage image) -> const gpu::Image& {
            return mTargets.emplace_back(gpu::Image::adopt(
                mDevice,
                "drawn",
                image,
                {push.sizePx.x,
                 push.sizePx.y,
                 VK_FORMAT_R16G16B16A16_SFLOAT,
                 VK_IMAGE_USAGE_STORAGE_BIT}
            ));
        };
        gpu::BindingList bindings;
        bindings.buffer(task.surfaces ? task.surfaces : mNothing.handle());
        bindings.storage(adopt(task.color.image));
        bindings.storage(adopt(task.opacity.image ? task.opacity.image : task.color.image));
        gpu::Frame& frame = *mFrames.emplace_back(gpu::Frame::createForHost(mDevice));
        frame.beginIn(task.commands);
        frame.bind(*mPipeline, bindings, &push, sizeof(push));
        vkCmdDispatch(task.commands, (push.sizePx.x + 7) / 8, (push.sizePx.y + 7) / 8, 1);
    }

    std::vector<BlendedTask> tasks;
    std::vector<double> times;

  private:
    struct Push {
        math::uvec2 sizePx;
        glm::ivec2 originPx;
        uint32_t firstInstant;
        uint32_t partInstantCount;
        uint32_t instantCount;
        uint32_t hasSurfaces;
        uint32_t isOpacityInAlpha;
        std::array<float, 16> times;
    };

    gpu::Device& mDevice;
    std::optional<gpu::Pipeline> mPipeline;
    gpu::Buffer mNothing;
    std::deque<gpu::Image> mTargets; ///< until the GPU is done
    std::vector<std::unique_ptr<gpu::Frame>> mFrames;
};

class EmbeddedBlended : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (!mBlur)
            return;
        mPane.emplace(device());
        mRaster = makeRaster(kRasterTime);
        mBefore = makeRaster(kRasterTime - 1.0);
    }

    void TearDown() override {
        mPane.reset();
        EmbeddedTest::TearDown();
    }

    /// The host's images and motion of a frame.
    struct Raster {
        const HostTexels* color = nullptr;
        const HostTexels* motionDepth = nullptr;
        const HostTexels* ids = nullptr;
        std::vector<HostCameraKey> keys;
        std::vector<glm::dmat4> matrices;
        std::vector<HostMover> movers; ///< point to `matrices`
    };

    /// \param rasterTime shutter time of the second frame
    Raster makeRaster(double rasterTime) {
        std::vector<uint64_t> color;
        std::vector<vec4> motionDepth;
        std::vector<uint32_t> ids;
        for (uint32_t y = 0; y < kBlendedSize.height; ++y)
            for (uint32_t x = 0; x < kBlendedSize.width; ++x) {
                const bool square = isSquare(x, y, rasterTime);
                color.push_back(test::packHalf(colorAt(x, y, rasterTime)));
                motionDepth.emplace_back(square ? 36.0f : 0.0f, 0.0f, square ? 5.0f : 10.0f, 0.0f);
                ids.push_back(square ? 1 : 0);
            }
        Raster raster;
        raster.color = &makeTexels(
            VK_FORMAT_R16G16B16A16_SFLOAT, kBlendedSize, color, VK_IMAGE_USAGE_STORAGE_BIT
        );
        raster.motionDepth = &makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kBlendedSize, motionDepth);
        raster.ids = &makeTexels(VK_FORMAT_R32_UINT, kBlendedSize, ids);
        // A metre is a pixel wide, from the left border.
        const glm::dmat4 lens = glm::translate(
            math::clipFromViewOrthographic(
                kBlendedSize.width / 2.0, kBlendedSize.height / 2.0, 0.1, 100.0
            ),
            glm::dvec3(kBlendedSize.width / -2.0, 0.0, 0.0)
        );
        for (const double time : {0.0, 0.5, 1.0}) {
            const double left = squareAt(rasterTime - kRasterTime + time);
            raster.keys.push_back({time, glm::dmat4(1.0), lens});
            raster.matrices.push_back(glm::translate(glm::dmat4(1.0), glm::dvec3(left, 0.0, -5.0)));
        }
        raster.movers = {{1, raster.matrices}};
        return raster;
    }

    /// Without the blended layer.
    [[nodiscard]] HostInputs describe() const { return describe(mRaster); }

    static HostInputs describe(const Raster& raster) {
        HostInputs inputs;
        inputs.width = kBlendedSize.width;
        inputs.height = kBlendedSize.height;
        inputs.color = raster.color->describe();
        inputs.motionDepth = raster.motionDepth->describe();
        inputs.entityId = raster.ids->describe();
        inputs.rasterTime = kRasterTime;
        inputs.motion.keys = raster.keys;
        inputs.motion.movers = raster.movers;
        inputs.motion.rowCount = 2;
        return inputs;
    }

    [[nodiscard]] HostInputs describeDrawn() {
        HostInputs inputs = describe();
        inputs.drawn.record = [this](const BlendedTask& task) { mPane->draw(task); };
        return inputs;
    }

    image::Image draw(const HostInputs& inputs, const char* method = "resolved") {
        if (inputs.motion.followsLast) {
            (void)EmbeddedTest::draw(describe(mBefore), test::settingsOf(method, kBlendedInstants));
            EXPECT_TRUE(mBlur->markDone(0).ok());
        }
        mPane->tasks.clear();
        image::Image picture =
            EmbeddedTest::draw(inputs, test::settingsOf(method, kBlendedInstants));
        EXPECT_TRUE(mBlur->markDone(0).ok());
        return picture;
    }

    /// Of one texel everywhere.
    HostImage makeLayer(const vec4& texel, VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT) {
        return makeTexels(format, kBlendedSize, std::vector<vec4>(kPixels, texel)).describe();
    }

    /// Sentences of the checker for the layer.
    std::vector<std::string> check(const vec4& texel) {
        std::vector<std::string> reported;
        motion_blur::HostDevice host = describeHost();
        host.checksInputs = true;
        host.message = [&](std::string_view sentence) {
            if (sentence.find("blended") != std::string_view::npos)
                reported.emplace_back(sentence);
        };
        mBlur = create(host);
        HostInputs inputs = describe();
        inputs.blended = makeLayer(texel);
        (void)draw(inputs, "gather");
        mBlur = create(describeHost());
        return reported;
    }

    void expectSameInPlace(const HostInputs& inputs, const image::Image& picture) {
        const gpu::Buffer pixels(
            device(), "pixels", kPixels * sizeof(uint64_t), 0, gpu::MemoryUse::Readback
        );
        run(inputs, test::gather(), 0, [&](VkCommandBuffer commands) {
            test::copyToBuffer(commands, mRaster.color->image(), pixels);
        });
        EXPECT_TRUE(mBlur->markDone(0).ok());
        const auto* texels = static_cast<const uint64_t*>(pixels.mapped());
        for (uint32_t i = 0; i < kPixels; ++i)
            ASSERT_EQ(glm::unpackHalf4x16(texels[i]).x, picture.pixels[4 * i]) << i;
    }

    static constexpr size_t kPixels = size_t{kBlendedSize.width} * kBlendedSize.height;

    std::optional<PaneHost> mPane;
    Raster mRaster;
    Raster mBefore; ///< of the previous frame, which shows the wall behind the square
};

TEST_F(EmbeddedBlended, LayersDrawnPerInstantAreHiddenAndTransparentAtEachInstant) {
    const image::Image truth = makeTruth();
    HostInputs inputs = describeDrawn();
    inputs.motion.followsLast = true;
    const double parts = image::computePsnr(draw(inputs), truth);
    ASSERT_EQ(mPane->tasks.size(), 4u);
    EXPECT_EQ(mPane->tasks[0].instantCount, 15u);
    EXPECT_EQ(mPane->times.front(), 0.5 / kBlendedInstants);
    EXPECT_EQ(mPane->times.back(), 14.5 / kBlendedInstants);
    uint32_t next = 0;
    for (const BlendedTask& task : mPane->tasks) {
        EXPECT_EQ(task.firstInstant, next);
        next += task.partInstantCount;
    }
    EXPECT_EQ(next, 15u);
    inputs.drawn.partCount = 1;
    const double whole = image::computePsnr(draw(inputs), truth);
    EXPECT_EQ(mPane->tasks.size(), 1u);
    const double filtered = image::computePsnr(draw(inputs, "gather"), truth);
    EXPECT_EQ(mPane->tasks[0].surfaces, VkBuffer{}) << "a filter has no lookups";
    RecordProperty("parts", std::to_string(parts));
    RecordProperty("whole", std::to_string(whole));
    RecordProperty("filtered", std::to_string(filtered));
    EXPECT_GT(parts, 48.0);
    EXPECT_GT(parts, whole + 10.0);
    EXPECT_GT(whole, filtered + 6.0);
}

TEST_F(EmbeddedBlended, BothInterfacesAndAlphaOpacityGiveTheSamePicture) {
    HostInputs inputs = describeDrawn();
    const image::Image picture = draw(inputs);
    const test::BlurOfC c(device());
    const test::Picture output(device(), {kBlendedSize.width, kBlendedSize.height});
    inputs.output = output.output();
    const test::InputsForC reported(inputs);
    ShutterBlurSettings settings = shutterBlurDefaultSettings();
    settings.method = "resolved";
    settings.sampleCount = kBlendedInstants;
    submit([&](VkCommandBuffer commands) {
        for (const HostTexels& texels : mTexels)
            texels.record(commands);
        EXPECT_EQ(
            shutterBlurRecord(c.blur, commands, 0, &reported.inputs, &settings),
            SHUTTER_BLUR_SUCCESS
        ) << shutterBlurGetMessage();
        output.recordReadback(commands);
    });
    EXPECT_TRUE(test::sameBits(output.read(), picture));
    inputs.drawn.isOpacityInAlpha = true;
    EXPECT_TRUE(test::sameBits(draw(inputs), picture));
    EXPECT_EQ(mPane->tasks[0].opacity.image, VkImage{});
}

TEST_F(EmbeddedBlended, ALayerDrawnInAnAreaChangesNothingOutside) {
    HostInputs inputs = describeDrawn();
    const image::Image whole = draw(inputs);
    const image::Image without = draw(describe());
    for (const VkRect2D& area : {VkRect2D{{35, 6}, {72, 36}}, VkRect2D{{60, 0}, {20, 48}}}) {
        inputs.drawn.area = area;
        const image::Image picture = draw(inputs);
        EXPECT_EQ(mPane->tasks[0].area.extent.width, area.extent.width);
        for (uint32_t i = 0; i < kPixels; ++i) {
            const uint32_t x = i % kBlendedSize.width - uint32_t(area.offset.x);
            const uint32_t y = i / kBlendedSize.width - uint32_t(area.offset.y);
            const bool isInside = x < area.extent.width && y < area.extent.height;
            const image::Image& same = isInside ? whole : without;
            for (size_t channel = 0; channel < 4; ++channel)
                ASSERT_EQ(picture.pixels[4 * i + channel], same.pixels[4 * i + channel]) << x;
        }
    }
}

TEST_F(EmbeddedBlended, InstantsBeyondThoseOfTheMethodAreNotDrawn) {
    HostInputs inputs = describeDrawn();
    inputs.drawn.instantCount = 200;
    (void)draw(inputs);
    EXPECT_EQ(mPane->tasks[0].instantCount, 15u);
    inputs.drawn.instantCount = 3;
    (void)draw(inputs);
    ASSERT_EQ(mPane->tasks.size(), 3u);
    EXPECT_EQ(mPane->tasks[0].instantCount, 3u);
    (void)draw(inputs, "gather");
    ASSERT_EQ(mPane->tasks.size(), 1u);
    EXPECT_EQ(mPane->tasks[0].instantCount, 3u);
}

TEST_F(EmbeddedBlended, TheLayerIsDrawnOverTheSharpPictureWithBlurOff) {
    const vec4 layer(0.25f, 0.125f, 0.0f, 0.5f);
    HostInputs inputs = describe();
    inputs.isOff = true;
    inputs.blended = makeLayer(layer);
    image::Image expected(kBlendedSize.width, kBlendedSize.height, 4);
    for (uint32_t i = 0; i < kPixels; ++i) {
        const vec4 color = glm::unpackHalf4x16(
            test::packHalf(colorAt(i % kBlendedSize.width, i / kBlendedSize.width, 0.5))
        );
        const vec4 sum = layer + 0.5f * color;
        for (size_t channel = 0; channel < 4; ++channel)
            expected.pixels[4 * i + channel] = channel < 3 ? sum[int(channel)] : 1.0f;
    }
    constexpr float kHalfStep = 5.0e-4f;
    const image::Image picture = draw(inputs);
    for (size_t i = 0; i < 4 * kPixels; ++i)
        ASSERT_NEAR(picture.pixels[i], expected.pixels[i], kHalfStep) << i;
    expectSameInPlace(inputs, picture);
    // Draws are of the raster's instant.
    inputs = describeDrawn();
    inputs.isOff = true;
    const image::Image drawn = draw(inputs);
    ASSERT_EQ(mPane->tasks.size(), 1u);
    EXPECT_EQ(mPane->times, std::vector<double>{0.5});
    EXPECT_EQ(mPane->tasks[0].surfaces, VkBuffer{});
    expectSameInPlace(inputs, drawn);
    inputs.drawn = {};
    EXPECT_FALSE(test::sameBits(drawn, draw(inputs)));
}

TEST_F(EmbeddedBlended, PartOfALargerImageGivesTheSamePicture) {
    constexpr VkExtent2D kLarger{kBlendedSize.width + 9, kBlendedSize.height + 5};
    std::vector<vec4> own(kPixels);
    std::vector<vec4> larger(size_t{kLarger.width} * kLarger.height, vec4(7.0f));
    for (uint32_t y = 0; y < kBlendedSize.height; ++y)
        for (uint32_t x = 0; x < kBlendedSize.width; ++x) {
            const vec4 texel(float(x) / 128.0f, 0.25f, float(y) / 64.0f, float((x + y) % 3) / 2.0f);
            own[size_t{y} * kBlendedSize.width + x] = texel;
            larger[size_t{y + 3} * kLarger.width + x + 6] = texel;
        }
    HostInputs inputs = describe();
    inputs.blended = makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kBlendedSize, own).describe();
    const image::Image picture = draw(inputs, "gather");
    EXPECT_FALSE(test::sameBits(picture, draw(describe(), "gather")));
    inputs.blended = makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kLarger, larger)
                         .describe({{6, 3}, {kBlendedSize.width, kBlendedSize.height}});
    EXPECT_TRUE(test::sameBits(draw(inputs, "gather"), picture));
}

TEST_F(EmbeddedBlended, NonFiniteInputsLeaveThePictureUnchangedOrFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    HostInputs inputs = describe();
    const image::Image without = draw(inputs, "gather");
    for (const vec4& texel : {vec4(0.0f), vec4(nan), vec4(-1.0f), vec4(0, 0, 0, -infinity)}) {
        inputs.blended = makeLayer(texel);
        EXPECT_TRUE(test::sameBits(draw(inputs, "gather"), without)) << texel.x << " " << texel.a;
    }
    for (const vec4& texel : {vec4(infinity), vec4(1.0f, 1.0f, 1.0f, 1.0e30f)}) {
        inputs.blended = makeLayer(texel);
        EXPECT_TRUE(test::allFinite(draw(inputs, "gather")));
    }
}

TEST_F(EmbeddedBlended, TheCheckerNamesWhatIsNoLightAndNoOpacity) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto expectReported = [&](const vec4& texel, const char* part) {
        const std::vector<std::string> reported = check(texel);
        ASSERT_EQ(reported.size(), 1u) << part;
        EXPECT_NE(reported[0].find(part), std::string::npos) << reported[0];
    };
    expectReported({nan, 0, 0, 0}, "blended holds NaN or infinity at 6144 pixels (100 %)");
    expectReported({0, 0, 0, nan}, "blended holds NaN or infinity");
    expectReported({0, -0.5f, 0, 0.5f}, "blended is negative");
    expectReported({0, 0, 0, 1.5f}, "the alpha of blended is outside [0, 1]");
    expectReported({0, 0, 0, -0.5f}, "the alpha of blended is outside [0, 1]");
    for (const vec4& texel : {vec4(0.0f), vec4(1.0f), vec4(900, 0, 0, 0), vec4(1.0f / 2049.0f)})
        EXPECT_TRUE(check(texel).empty());
}

TEST_F(EmbeddedBlended, InvalidInputsAreRefused) {
    const auto refuse = [&](const char* part, const auto& change) {
        HostInputs inputs = describeDrawn();
        const test::Picture picture(device(), {kBlendedSize.width, kBlendedSize.height});
        inputs.output = picture.output();
        change(inputs);
        submit([&](VkCommandBuffer commands) {
            test::expectRefusal(
                mBlur->record(commands, 0, inputs, test::settingsOf("resolved")), part
            );
        });
    };
    refuse("blendedInstants is 257, it must be 0 to 256", [](HostInputs& in) {
        in.drawn.instantCount = 257;
    });
    refuse("blendedParts is 5, it must be 0 to 4", [](HostInputs& in) { in.drawn.partCount = 5; });
    for (const VkRect2D& area :
         {VkRect2D{{-1, 0}, {8, 8}},
          VkRect2D{{0, 41}, {8, 8}},
          VkRect2D{{0, 0}, {129, 8}},
          VkRect2D{{0, 0}, {8, 0}}})
        refuse("outside of the picture of 128 x 48", [&](HostInputs& in) { in.drawn.area = area; });
    test::expectRefusal(
        motion_blur::checkDrawn(describeDrawn(), test::settingsOf("resolved", 15), 1000),
        "blendedArea of 128 x 48 with 15 instants takes a buffer of 393248 bytes"
    );
    EXPECT_TRUE(motion_blur::checkDrawn(describeDrawn(), test::gather(), 1000).ok());
    refuse("blended.image is color.image", [](HostInputs& in) { in.blended = in.color; });
    refuse("blended.format is", [&](HostInputs& in) {
        in.blended = mRaster.ids->describe();
        in.entityId = {};
        in.motion.movers = {};
    });
    refuse("blended.area.extent is 8 x 8", [&](HostInputs& in) {
        in.blended = makeLayer(vec4(0.0f));
        in.blended.area = {{0, 0}, {8, 8}};
    });
}

TEST_F(EmbeddedBlended, ReplayGivesTheHostsPicture) {
    const test::TempFolder folder;
    const auto replay = [&](const std::filesystem::path& dump, const char* method) {
        replay::ReplayOptions options;
        options.folder = dump;
        options.out = folder.path() / "replayed.exr";
        options.change = [&](MotionBlurSettings& settings) -> core::Status {
            settings.method = &motion_blur::getMethod(method);
            return {};
        };
        return replay::replay(options, device());
    };
    for (const bool isInAlpha : {false, true}) {
        HostInputs inputs = describeDrawn();
        inputs.drawn.isOpacityInAlpha = isInAlpha;
        inputs.drawn.area = {{35, 6}, {72, 36}};
        inputs.drawn.partCount = 2;
        inputs.blended = makeLayer({0.1f, 0.0f, 0.2f, 0.25f});
        const auto dump = folder.path() / (isInAlpha ? "alpha" : "red");
        ASSERT_TRUE(mBlur->dump(dump, 1).ok());
        const image::Image picture = draw(inputs);
        const core::Status done = replay(dump, "resolved");
        ASSERT_TRUE(done.ok()) << done.error().message;
        const auto replayed = io::readImage(folder.path() / "replayed.exr");
        ASSERT_TRUE(replayed.ok()) << replayed.error().message;
        EXPECT_TRUE(test::sameBits(replayed.value(), picture));
        test::expectRefusal(
            replay(dump, "gather"), "the host drew over it at 15 instants in 2 parts, which are 15"
        );
        const auto manifest = dump / "frame_0000.json";
        const auto bytes = io::readFileBytes(manifest, 1 << 20);
        ASSERT_TRUE(bytes.ok());
        const std::string text(bytes.value().begin(), bytes.value().end());
        const auto change = [&](const std::string& from, const std::string& to, const char* wanted
                            ) {
            std::string changed = text;
            ASSERT_NE(text.find(from), std::string::npos) << from;
            changed.replace(text.find(from), from.size(), to);
            ASSERT_TRUE(io::writeFileText(manifest, changed).ok());
            test::expectRefusal(replay(dump, "resolved"), wanted);
        };
        change("\"parts\": 2", "\"parts\": 5", "parts");
        change("\"instants\": 15", "\"instants\": 0", "instants");
        change("drawnColor1\": {", "drawnColor3\": {", "has no 'drawnColor1' of 72 x 36");
        change("drawnColor0\": {", "elsewhere\": {", "is no image of a dump");
        ASSERT_TRUE(io::writeFileText(manifest, text).ok());
        std::filesystem::remove(dump / "frame_0000_drawnColor1.bin");
        test::expectRefusal(replay(dump, "resolved"), "drawnColor1.bin");
    }
}

} // namespace
} // namespace shutter
