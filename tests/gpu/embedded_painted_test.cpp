// SPDX-License-Identifier: MIT
// Hosts that draw a square before a wall, of which the picture at each instant is known: deformed
// by the host, which gives per-pixel displacements; or under transparent surfaces, which go over
// the blurred picture as an image of the whole exposure, or drawn by the host at instants against
// the depths that the method saw.
#include "spirv/draw_blended.comp.h"

#include "engine/image/metrics.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/math/transform.h"
#include "game/replay/replay_run.h"
#include "modules/motion_blur/embedding/host_blended.h"
#include "tests/gpu/embedding_host.h"
#include "tests/support/picture.h"
#include "tests/support/temp_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
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

constexpr VkExtent2D kPaintedSize{128, 48};
constexpr size_t kPixels = size_t{kPaintedSize.width} * kPaintedSize.height;
constexpr int kPaintedInstants = 15;
constexpr uint32_t kWallRow = 0;
constexpr uint32_t kSquareRow = 1;
constexpr float kPaintedNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kPaintedInfinity = std::numeric_limits<float>::infinity();

/// A square that slides before a wall, which may slide, too. Each moves rigidly, but a host that
/// deforms one does not declare that. Places are pixels, times shutter times of the second frame.
struct World {
    /// \param in pixels from the row's left edge
    vec4 (*colorOf)(uint32_t row, double in, uint32_t y) = nullptr;
    double (*squareAt)(double time) = nullptr; ///< left edge
    double (*wallAt)(double time) = [](double) { return 0.0; };
    uint32_t deformed = 2; ///< row of what the host deforms

    [[nodiscard]] double placeOf(uint32_t row, double time) const {
        return row == kSquareRow ? squareAt(time) : wallAt(time);
    }

    [[nodiscard]] uint32_t rowAt(uint32_t x, uint32_t y, double time) const {
        const double in = x + 0.5 - squareAt(time);
        return in >= 0.0 && in < 24.0 && y >= 12 && y < 36 ? kSquareRow : kWallRow;
    }

    [[nodiscard]] vec4 colorAt(uint32_t x, uint32_t y, double time) const {
        const uint32_t row = rowAt(x, y, time);
        return colorOf(row, x + 0.5 - placeOf(row, time), y);
    }
};

/// Mean of the instants' pictures.
image::Image makeTruth(const std::function<vec4(uint32_t x, uint32_t y, double time)>& colorAt) {
    image::Image truth(kPaintedSize.width, kPaintedSize.height, 4);
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
        for (int i = 0; i < kPaintedInstants; ++i) {
            const vec4 color = colorAt(
                pixel % kPaintedSize.width, pixel / kPaintedSize.width, (i + 0.5) / kPaintedInstants
            );
            for (uint32_t channel = 0; channel < 4; ++channel)
                truth.pixels[4 * pixel + channel] += color[int(channel)] / kPaintedInstants;
        }
    return truth;
}

class PaintedTest : public test::EmbeddedTest {
  protected:
    /// The host's images and motion of a frame.
    struct Raster {
        const HostTexels* color = nullptr;
        const HostTexels* motionDepth = nullptr;
        const HostTexels* ids = nullptr;
        const HostTexels* deformed = nullptr;
        std::vector<HostCameraKey> keys;
        std::deque<std::vector<glm::dmat4>> matrices; ///< of `movers`
        std::vector<HostMover> movers;

        /// Without displacements.
        [[nodiscard]] HostInputs describe(double rasterTime) const {
            HostInputs inputs;
            inputs.width = kPaintedSize.width;
            inputs.height = kPaintedSize.height;
            inputs.color = color->describe();
            inputs.motionDepth = motionDepth->describe();
            inputs.entityId = ids->describe();
            inputs.rasterTime = rasterTime;
            inputs.convention.scales.exposureShare = 1.0f;
            inputs.motion.keys = keys;
            inputs.motion.movers = movers;
            inputs.motion.rowCount = 2;
            return inputs;
        }
    };

    /// \param rasterTime of its frame
    /// \param frame after the second one
    Raster makeRaster(const World& world, double rasterTime, double frame) {
        const double time = frame + rasterTime;
        std::vector<uint64_t> color;
        std::vector<vec4> motionDepth;
        std::vector<uint32_t> ids;
        std::vector<vec4> deformed;
        for (uint32_t y = 0; y < kPaintedSize.height; ++y)
            for (uint32_t x = 0; x < kPaintedSize.width; ++x) {
                const uint32_t row = world.rowAt(x, y, time);
                const double place = world.placeOf(row, time);
                const auto toOpen = float(world.placeOf(row, 0.0) - place);
                const auto toClose = float(world.placeOf(row, 1.0) - place);
                color.push_back(test::packHalf(world.colorAt(x, y, time)));
                motionDepth.emplace_back(toClose - toOpen, 0.0f, depthOf(row), 0.0f);
                ids.push_back(row);
                // Values of pixels that do not deform are ignored.
                deformed.push_back(
                    row == world.deformed ? vec4(toOpen, 0, toClose, 0) : vec4(kPaintedNan)
                );
            }
        Raster raster;
        raster.color = &makeTexels(
            VK_FORMAT_R16G16B16A16_SFLOAT, kPaintedSize, color, VK_IMAGE_USAGE_STORAGE_BIT
        );
        raster.motionDepth = &makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kPaintedSize, motionDepth);
        raster.ids = &makeTexels(VK_FORMAT_R32_UINT, kPaintedSize, ids);
        raster.deformed = &makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kPaintedSize, deformed);
        // A metre is a pixel wide, from the left border.
        const glm::dvec2 half(kPaintedSize.width / 2.0, kPaintedSize.height / 2.0);
        const glm::dmat4 lens = glm::translate(
            math::clipFromViewOrthographic(half.x, half.y, 0.1, 100.0),
            glm::dvec3(-half.x, 0.0, 0.0)
        );
        for (const double at : {0.0, 0.5, 1.0})
            raster.keys.push_back({at, glm::dmat4(1.0), lens});
        for (const uint32_t row : {kWallRow, kSquareRow}) {
            std::vector<glm::dmat4>& matrices = raster.matrices.emplace_back();
            for (const HostCameraKey& key : raster.keys)
                matrices.push_back(glm::translate(
                    glm::dmat4(1.0),
                    glm::dvec3(world.placeOf(row, frame + key.time), 0.0, -double(depthOf(row)))
                ));
            if (row == world.deformed)
                matrices.clear();
            raster.movers.push_back({row, matrices});
        }
        return raster;
    }

    static float depthOf(uint32_t row) { return row == kSquareRow ? 5.0f : 10.0f; }
};

class EmbeddedDeformed : public PaintedTest {
  protected:
    struct Given {
        const char* method = "resolved";
        bool deformed = true;
        bool lastDeformed = true;
        double rasterTime = 1.0;
    };

    /// The second of two frames. Its exposure is as long as the time between them.
    image::Image draw(const World& world, const Given& given) {
        forgetFrames();
        mTexels.clear();
        const std::array rasters{
            makeRaster(world, given.rasterTime, -1.0), makeRaster(world, given.rasterTime, 0.0)};
        image::Image picture;
        for (uint32_t frame = 0; frame < 2; ++frame) {
            HostInputs inputs = rasters[frame].describe(given.rasterTime);
            if (given.deformed)
                inputs.deformedMotion = rasters[frame].deformed->describe();
            if (frame == 1 && given.lastDeformed)
                inputs.lastDeformedMotion = rasters[0].deformed->describe();
            inputs.motion.followsLast = frame == 1;
            picture =
                EmbeddedTest::draw(inputs, test::settingsOf(given.method, kPaintedInstants), frame);
            EXPECT_TRUE(mBlur->markDone(frame).ok());
        }
        return picture;
    }

    static image::Image makeTruthOf(const World& world) {
        return makeTruth([&](uint32_t x, uint32_t y, double time) {
            return world.colorAt(x, y, time);
        });
    }
};

vec4 chequer(uint32_t row, double in, uint32_t y) {
    if (row == kSquareRow)
        return in < 12.0 ? vec4(0.9f, 0.2f, 0.1f, 1.0f) : vec4(0.9f, 0.8f, 0.1f, 1.0f);
    return (int(std::floor(in / 8.0)) + int(y) / 8) % 2 == 0 ? vec4(0.6f, 0.6f, 0.7f, 1.0f)
                                                             : vec4(0.1f, 0.1f, 0.3f, 1.0f);
}

constexpr World kSliding{.colorOf = chequer, .squareAt = [](double t) { return 40.0 + 17.3 * t; }};
/// Brakes: 20 px in the first half of the exposure, 12 in the second.
constexpr World kBraking{
    .colorOf = chequer,
    .squareAt = [](double t) { return 40.0 + 32.0 * t - 16.0 * (t * t - 0.25); },
    .deformed = kSquareRow};
/// A wall that waves slowly, and that the square uncovers.
constexpr World kUncovering{
    .colorOf = chequer,
    .squareAt = [](double t) { return 30.0 + 40.0 * t; },
    .wallAt = [](double t) { return -7.0 * t; },
    .deformed = kWallRow};

TEST_F(EmbeddedDeformed, AWayThatBendsIsFollowedThroughTheRaster) {
    const image::Image truth = makeTruthOf(kBraking);
    const double bent = image::computePsnr(draw(kBraking, {.rasterTime = 0.5}), truth);
    const double straight = image::computePsnr(
        draw(kBraking, {.deformed = false, .lastDeformed = false, .rasterTime = 0.5}), truth
    );
    EXPECT_GT(bent, straight + 6.0);
    EXPECT_GT(bent, 30.0);
}

TEST_F(EmbeddedDeformed, UncoveredSurfacesAreFoundInTheLastRasterWhichADumpHolds) {
    const image::Image truth = makeTruthOf(kUncovering);
    const test::TempFolder folder;
    replay::ReplayOptions options;
    options.folder = folder.path() / "dump";
    options.out = folder.path() / "replayed.exr";
    ASSERT_TRUE(mBlur->dump(options.folder, 2).ok());
    const image::Image picture = draw(kUncovering, {});
    const double found = image::computePsnr(picture, truth);
    const double guessed = image::computePsnr(draw(kUncovering, {.lastDeformed = false}), truth);
    EXPECT_GT(found, guessed + 6.0);
    EXPECT_GT(found, 30.0);
    const core::Status done = replay::replay(options, device());
    ASSERT_TRUE(done.ok()) << done.error().message;
    const auto replayed = io::readImage(folder.path() / "replayed_0001.exr");
    ASSERT_TRUE(replayed.ok()) << replayed.error().message;
    EXPECT_TRUE(test::sameBits(replayed.value(), picture));
}

TEST_F(EmbeddedDeformed, ADepthOf0NextToAMoverLosesNoSampleOfIt) {
    const double rasterTime = 0.5;
    const auto drawWithWallAt = [&](float depth) {
        forgetFrames();
        mTexels.clear();
        Raster raster = makeRaster(kSliding, rasterTime, 0.0);
        uint32_t leftOfSquare = 0;
        while (kSliding.rowAt(leftOfSquare, kPaintedSize.height / 2, rasterTime) != kSquareRow)
            ++leftOfSquare;
        std::vector<vec4> motionDepth;
        for (uint32_t y = 0; y < kPaintedSize.height; ++y)
            for (uint32_t x = 0; x < kPaintedSize.width; ++x) {
                // Tilted, so that its place depends on the depth, which is interpolated.
                const float slope = 0.8f + 0.4f * float(y) / float(kPaintedSize.height);
                motionDepth.push_back(
                    kSliding.rowAt(x, y, rasterTime) == kSquareRow
                        ? vec4(17.3f, 0.0f, depthOf(kSquareRow) * slope, 0.0f)
                        : vec4(0.0f, 0.0f, x < leftOfSquare ? depth : 20.0f, 0.0f)
                );
            }
        raster.motionDepth = &makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kPaintedSize, motionDepth);
        // A metre at a distance of 64 m is a pixel wide.
        const glm::dvec2 half(kPaintedSize.width / 2.0, kPaintedSize.height / 2.0);
        for (HostCameraKey& key : raster.keys)
            key.clipFromView =
                math::clipFromViewPerspective(2.0 * std::atan(half.y / 64.0), half.x / half.y, 0.1);
        for (std::vector<glm::dmat4>& matrices : raster.matrices)
            for (glm::dmat4& matrix : matrices)
                matrix[3].x *= -matrix[3].z / 64.0;
        return EmbeddedTest::draw(
            raster.describe(rasterTime), test::settingsOf("resolved", kPaintedInstants)
        );
    };
    const image::Image nearest = drawWithWallAt(1e-6f);
    EXPECT_GT(image::computePsnr(drawWithWallAt(0.0f), nearest), 70.0);
    EXPECT_LT(image::computePsnr(drawWithWallAt(20.0f), nearest), 70.0) << "it hides the square";
}

TEST_F(EmbeddedDeformed, DeformersWithoutMotionImagesAreNoWorseThanGathered) {
    for (const World& world : {kBraking, kUncovering}) {
        const image::Image truth = makeTruthOf(world);
        const Given without{.deformed = false, .lastDeformed = false};
        Given gathered = without;
        gathered.method = "gather";
        EXPECT_GT(
            image::computePsnr(draw(world, without), truth),
            image::computePsnr(draw(world, gathered), truth) - 0.3
        );
    }
}

TEST_F(EmbeddedDeformed, TheLastRastersMotionAloneIsRefused) {
    const Raster raster = makeRaster(kUncovering, 1.0, 0.0);
    HostInputs inputs = raster.describe(1.0);
    inputs.lastDeformedMotion = raster.deformed->describe();
    submit([&](VkCommandBuffer commands) {
        test::expectRefusal(
            mBlur->record(commands, 0, inputs, test::settingsOf("resolved")),
            "deformedMotion.image is null"
        );
    });
}

constexpr double kBlendedRaster = 0.5;        ///< its shutter time
constexpr vec4 kPane{0.1f, 0.9f, 0.3f, 0.5f}; // of draw_blended.comp

/// The pane of draw_blended.comp meets the square. Stripes along the square's path: uncovered parts
/// are visible next to it.
constexpr World kStriped{
    .colorOf =
        [](uint32_t row, double, uint32_t y) {
            return row == kSquareRow ? vec4(0.9f, 0.2f, 0.1f, 1.0f)
                   : y / 8 % 2 == 0  ? vec4(0.6f, 0.6f, 0.7f, 1.0f)
                                     : vec4(0.1f, 0.1f, 0.3f, 1.0f);
        },
    .squareAt = [](double time) { return 30.0 + 36.0 * time; }};

/// With the share of light that the pane takes, by its instant's place and the surfaces in front of
/// it.
vec4 seeThroughPane(uint32_t x, uint32_t y, double time) {
    const double in = x + 0.5 - (70.0 - 30.0 * time);
    const bool isHidden = y >= 24 && kStriped.rowAt(x, y, time) == kSquareRow;
    const bool isSeen = in >= 0.0 && in < 32.0 && y >= 8 && y < 40 && !isHidden;
    const vec4 behind = kStriped.colorAt(x, y, time);
    return isSeen ? glm::mix(behind, vec4(math::vec3(kPane), 1.0f), kPane.a) : behind;
}

/// Draws the pane by a compute shader of the host's.
class PaneHost {
  public:
    explicit PaneHost(gpu::Device& device)
        : mShader(
              device,
              {.name = "the host's pane",
               .spirv = draw_blended_comp,
               .interface =
                   {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                     VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                     VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                    sizeof(Push)}}
          ),
          mNothing(
              device, "nothing", 32, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryUse::Device
          ) {}

    void draw(const BlendedTask& task) {
        tasks.push_back(task);
        times.assign(task.times, task.times + task.instantCount);
        ASSERT_EQ(task.structBytes, sizeof(task));
        ASSERT_LE(task.firstInstant + task.partInstantCount, task.instantCount);
        ASSERT_LE(task.partInstantCount, 16u);
        const VkExtent2D size = task.area.extent;
        Push push{};
        push.sizePx = {size.width, size.height};
        push.originPx = {task.area.offset.x, task.area.offset.y};
        push.firstInstant = task.firstInstant;
        push.partInstantCount = task.partInstantCount;
        push.instantCount = task.instantCount;
        push.hasSurfaces = task.surfaces ? 1 : 0;
        push.isOpacityInAlpha = task.opacity.image ? 0 : 1;
        for (uint32_t i = 0; i < task.partInstantCount; ++i)
            push.times[i] = float(task.times[task.firstInstant + i]);
        gpu::BindingList bindings;
        bindings.buffer(task.surfaces ? task.surfaces : mNothing.handle());
        for (const VkImage image :
             {task.color.image, task.opacity.image ? task.opacity.image : task.color.image})
            bindings.storage(mShader.adopt(
                image, size, VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_STORAGE_BIT
            ));
        mShader.bind(task.commands, bindings, push);
        vkCmdDispatch(task.commands, (size.width + 7) / 8, (size.height + 7) / 8, 1);
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

    test::HostShader mShader;
    gpu::Buffer mNothing;
};

class EmbeddedBlended : public PaintedTest {
  protected:
    void SetUp() override {
        PaintedTest::SetUp();
        if (!mBlur)
            return;
        mPane.emplace(device());
        mRaster = makeRaster(kStriped, kBlendedRaster, 0.0);
        mBefore = makeRaster(kStriped, kBlendedRaster, -1.0);
    }

    void TearDown() override {
        mPane.reset();
        PaintedTest::TearDown();
    }

    /// Without the blended layer.
    [[nodiscard]] HostInputs describe() const { return mRaster.describe(kBlendedRaster); }

    [[nodiscard]] HostInputs describeDrawn() {
        HostInputs inputs = describe();
        inputs.drawn.record = [this](const BlendedTask& task) { mPane->draw(task); };
        return inputs;
    }

    image::Image draw(const HostInputs& inputs, const char* method = "resolved") {
        if (inputs.motion.followsLast) {
            (void)EmbeddedTest::draw(
                mBefore.describe(kBlendedRaster), test::settingsOf(method, kPaintedInstants)
            );
            EXPECT_TRUE(mBlur->markDone(0).ok());
        }
        mPane->tasks.clear();
        image::Image picture =
            EmbeddedTest::draw(inputs, test::settingsOf(method, kPaintedInstants));
        EXPECT_TRUE(mBlur->markDone(0).ok());
        return picture;
    }

    /// A layer that has the same texel everywhere.
    HostImage makeLayer(const vec4& texel, VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT) {
        return makeTexels(format, kPaintedSize, std::vector<vec4>(kPixels, texel)).describe();
    }

    /// Sentences of the checker for layers of one texel everywhere, each in a frame.
    std::vector<std::string> check(const std::vector<vec4>& layers) {
        std::vector<std::string> reported;
        motion_blur::HostDevice host = describeHost();
        host.checksInputs = true;
        host.message = [&](std::string_view sentence) {
            if (sentence.find("blended") != std::string_view::npos)
                reported.emplace_back(sentence);
        };
        auto shared = std::exchange(mBlur, create(host));
        for (const vec4& texel : layers) {
            HostInputs inputs = describe();
            inputs.blended = makeLayer(texel);
            (void)draw(inputs, "own_velocity");
        }
        mBlur = std::move(shared);
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

    std::optional<PaneHost> mPane;
    Raster mRaster;
    Raster mBefore; ///< of the previous frame, which shows the wall behind the square
};

TEST_F(EmbeddedBlended, LayersDrawnPerInstantAreHiddenAndTransparentAtEachInstant) {
    const image::Image truth = makeTruth(seeThroughPane);
    HostInputs inputs = describeDrawn();
    inputs.motion.followsLast = true;
    const double parts = image::computePsnr(draw(inputs), truth);
    ASSERT_EQ(mPane->tasks.size(), 4u);
    EXPECT_EQ(mPane->tasks[0].instantCount, 15u);
    EXPECT_EQ(mPane->times.front(), 0.5 / kPaintedInstants);
    EXPECT_EQ(mPane->times.back(), 14.5 / kPaintedInstants);
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
    const test::Picture output(device(), {kPaintedSize.width, kPaintedSize.height});
    inputs.output = output.output();
    const test::InputsForC reported(inputs);
    ShutterBlurSettings settings = shutterBlurDefaultSettings();
    settings.method = "resolved";
    settings.sampleCount = kPaintedInstants;
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
            const uint32_t x = i % kPaintedSize.width - uint32_t(area.offset.x);
            const uint32_t y = i / kPaintedSize.width - uint32_t(area.offset.y);
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
    image::Image expected(kPaintedSize.width, kPaintedSize.height, 4);
    for (uint32_t i = 0; i < kPixels; ++i) {
        const vec4 color = glm::unpackHalf4x16(
            test::packHalf(kStriped.colorAt(i % kPaintedSize.width, i / kPaintedSize.width, 0.5))
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
    constexpr VkExtent2D kLarger{kPaintedSize.width + 9, kPaintedSize.height + 5};
    std::vector<vec4> own(kPixels);
    std::vector<vec4> larger(size_t{kLarger.width} * kLarger.height, vec4(7.0f));
    for (uint32_t y = 0; y < kPaintedSize.height; ++y)
        for (uint32_t x = 0; x < kPaintedSize.width; ++x) {
            const vec4 texel(float(x) / 128.0f, 0.25f, float(y) / 64.0f, float((x + y) % 3) / 2.0f);
            own[size_t{y} * kPaintedSize.width + x] = texel;
            larger[size_t{y + 3} * kLarger.width + x + 6] = texel;
        }
    HostInputs inputs = describe();
    inputs.blended = makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kPaintedSize, own).describe();
    const image::Image picture = draw(inputs, "gather");
    EXPECT_FALSE(test::sameBits(picture, draw(describe(), "gather")));
    inputs.blended = makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kLarger, larger)
                         .describe({{6, 3}, {kPaintedSize.width, kPaintedSize.height}});
    EXPECT_TRUE(test::sameBits(draw(inputs, "gather"), picture));
}

TEST_F(EmbeddedBlended, NonFiniteInputsLeaveThePictureUnchangedOrFinite) {
    HostInputs inputs = describe();
    const image::Image without = draw(inputs, "gather");
    for (const vec4& texel :
         {vec4(0.0f), vec4(kPaintedNan), vec4(-1.0f), vec4(0, 0, 0, -kPaintedInfinity)}) {
        inputs.blended = makeLayer(texel);
        EXPECT_TRUE(test::sameBits(draw(inputs, "gather"), without)) << texel.x << " " << texel.a;
    }
    for (const vec4& texel : {vec4(kPaintedInfinity), vec4(1.0f, 1.0f, 1.0f, 1.0e30f)}) {
        inputs.blended = makeLayer(texel);
        EXPECT_TRUE(test::allFinite(draw(inputs, "gather")));
    }
}

TEST_F(EmbeddedBlended, TheCheckerNamesWhatIsNoLightAndNoOpacity) {
    const auto expectReported = [&](const vec4& texel, const char* part) {
        const std::vector<std::string> reported = check({texel});
        ASSERT_EQ(reported.size(), 1u) << part;
        EXPECT_NE(reported[0].find(part), std::string::npos) << reported[0];
    };
    expectReported({kPaintedNan, 0, 0, 0}, "blended holds NaN or infinity at 6144 pixels (100 %)");
    expectReported({0, 0, 0, kPaintedNan}, "blended holds NaN or infinity");
    expectReported({0, -0.5f, 0, 0.5f}, "blended is negative");
    expectReported({0, 0, 0, 1.5f}, "the alpha of blended is outside [0, 1]");
    expectReported({0, 0, 0, -0.5f}, "the alpha of blended is outside [0, 1]");
    EXPECT_TRUE(check({vec4(0.0f), vec4(1.0f), vec4(900, 0, 0, 0), vec4(1.0f / 2049.0f)}).empty());
}

TEST_F(EmbeddedBlended, InvalidInputsAreRefused) {
    const auto refuse = [&](const char* part, const auto& change) {
        HostInputs inputs = describeDrawn();
        const test::Picture picture(device(), {kPaintedSize.width, kPaintedSize.height});
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
