// SPDX-License-Identifier: MIT
// Hosts that deform their meshes themselves and give per-pixel displacements.
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "engine/math/transform.h"
#include "game/replay/replay_run.h"
#include "tests/gpu/embedding_host.h"
#include "tests/support/picture.h"
#include "tests/support/temp_folder.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace shutter {
namespace {

using math::dvec2;
using math::vec4;
using motion_blur::HostCameraKey;
using motion_blur::HostInputs;
using motion_blur::HostMover;
using test::HostTexels;

constexpr VkExtent2D kDeformedSize{128, 48};
constexpr int kDeformedInstants = 15;
constexpr uint32_t kWallRow = 0;
constexpr uint32_t kSquareRow = 1;

/// A square of two colours that slides in front of a chequered wall, which may slide, too. Each
/// moves rigidly, but a host that deforms it does not declare that. Places are pixels, times
/// shutter times of the second frame.
struct World {
    double (*squareAt)(double time) = nullptr; ///< left edge
    double (*wallAt)(double time) = [](double) { return 0.0; };
    uint32_t deformed = kSquareRow; ///< row of what the host deforms; the other has transforms

    [[nodiscard]] double placeOf(uint32_t row, double time) const {
        return row == kSquareRow ? squareAt(time) : wallAt(time);
    }

    [[nodiscard]] uint32_t rowAt(uint32_t x, uint32_t y, double time) const {
        const double inSquare = x + 0.5 - squareAt(time);
        return inSquare >= 0.0 && inSquare < 24.0 && y >= 12 && y < 36 ? kSquareRow : kWallRow;
    }

    [[nodiscard]] vec4 colorAt(uint32_t x, uint32_t y, double time) const {
        const uint32_t row = rowAt(x, y, time);
        const double in = x + 0.5 - placeOf(row, time);
        if (row == kSquareRow)
            return in < 12.0 ? vec4(0.9f, 0.2f, 0.1f, 1.0f) : vec4(0.9f, 0.8f, 0.1f, 1.0f);
        return (int(std::floor(in / 8.0)) + int(y) / 8) % 2 == 0 ? vec4(0.6f, 0.6f, 0.7f, 1.0f)
                                                                 : vec4(0.1f, 0.1f, 0.3f, 1.0f);
    }
};

/// The host's images of one raster.
class Raster {
  public:
    Raster(gpu::Device& device, const World& world, double time)
        : Raster(device, fill(world, time)) {}

    void record(VkCommandBuffer commands) const {
        for (const HostTexels* image : {&color, &motionDepth, &entityId, &deformed})
            image->record(commands);
    }

  private:
    struct Texels {
        std::vector<uint64_t> color;
        std::vector<vec4> motionDepth;
        std::vector<uint32_t> ids;
        std::vector<vec4> deformed;
    };

    Raster(gpu::Device& device, const Texels& texels)
        : color(device, VK_FORMAT_R16G16B16A16_SFLOAT, kDeformedSize, test::bytesOf(texels.color)),
          motionDepth(
              device,
              VK_FORMAT_R32G32B32A32_SFLOAT,
              kDeformedSize,
              test::bytesOf(texels.motionDepth)
          ),
          entityId(device, VK_FORMAT_R32_UINT, kDeformedSize, test::bytesOf(texels.ids)),
          deformed(
              device, VK_FORMAT_R32G32B32A32_SFLOAT, kDeformedSize, test::bytesOf(texels.deformed)
          ) {}

    static Texels fill(const World& world, double time) {
        const float nan = std::numeric_limits<float>::quiet_NaN();
        Texels texels;
        for (uint32_t y = 0; y < kDeformedSize.height; ++y)
            for (uint32_t x = 0; x < kDeformedSize.width; ++x) {
                const uint32_t row = world.rowAt(x, y, time);
                const double place = world.placeOf(row, time);
                const auto toOpen = float(world.placeOf(row, 0.0) - place);
                const auto toClose = float(world.placeOf(row, 1.0) - place);
                texels.color.push_back(test::packHalf(world.colorAt(x, y, time)));
                texels.motionDepth.emplace_back(
                    toClose - toOpen, 0.0f, row == kWallRow ? 10.0f : 5.0f, 0.0f
                );
                texels.ids.push_back(row);
                // Values of pixels that do not deform are ignored.
                texels.deformed.push_back(
                    row == world.deformed ? vec4(toOpen, 0, toClose, 0) : vec4(nan)
                );
            }
        return texels;
    }

  public:
    HostTexels color;
    HostTexels motionDepth;
    HostTexels entityId;
    HostTexels deformed;
};

class EmbeddedDeformed : public test::EmbeddedTest {
  protected:
    struct Given {
        const char* method = "resolved";
        bool deformed = true;
        bool lastDeformed = true;
        double rasterTime = 1.0;
    };

    /// The second of two frames. Its exposure is as long as the time between them.
    image::Image draw(const World& world, const Given& given) {
        motion_blur::HostDevice host = describeHost();
        host.framesInFlight = 2;
        const auto blur = create(host);
        if (!mFolder.empty()) {
            EXPECT_TRUE(blur->dump(mFolder, 2).ok());
        }
        const double before = given.rasterTime - 1.0;
        image::Image result;
        const Raster last(device(), world, before);
        const Raster now(device(), world, given.rasterTime);
        for (uint32_t index = 0; index < 2; ++index) {
            const Raster& raster = index == 0 ? last : now;
            gpu::Frame frame(device());
            const test::Picture picture(device(), {kDeformedSize.width, kDeformedSize.height});
            frame.begin();
            const VkCommandBuffer commands = frame.commands();
            raster.record(commands);
            HostInputs inputs = describe(world, raster, given);
            inputs.output = picture.output();
            inputs.motion.followsLast = index == 1;
            if (index == 1 && given.lastDeformed) {
                last.deformed.record(commands);
                inputs.lastDeformedMotion = last.deformed.describe();
            }
            const core::Status done = blur->record(
                commands, index, inputs, test::settingsOf(given.method, kDeformedInstants)
            );
            EXPECT_TRUE(done.ok()) << done.error().message;
            picture.recordReadback(commands);
            frame.submit();
            frame.wait();
            EXPECT_TRUE(blur->markDone(index).ok());
            result = picture.read();
        }
        return result;
    }

    HostInputs describe(const World& world, const Raster& raster, const Given& given) {
        HostInputs inputs;
        inputs.width = kDeformedSize.width;
        inputs.height = kDeformedSize.height;
        inputs.color = raster.color.describe();
        inputs.motionDepth = raster.motionDepth.describe();
        inputs.entityId = raster.entityId.describe();
        if (given.deformed)
            inputs.deformedMotion = raster.deformed.describe();
        inputs.rasterTime = given.rasterTime;
        inputs.convention.scales.exposureShare = 1.0f;
        // A metre is a pixel wide, from the left border.
        const glm::dmat4 lens = glm::translate(
            math::clipFromViewOrthographic(
                kDeformedSize.width / 2.0, kDeformedSize.height / 2.0, 0.1, 100.0
            ),
            glm::dvec3(kDeformedSize.width / -2.0, 0.0, 0.0)
        );
        mKeys.clear();
        mMatrices.clear();
        const uint32_t rigid = world.deformed == kSquareRow ? kWallRow : kSquareRow;
        for (const double time : {0.0, 0.5, 1.0}) {
            mKeys.push_back({time, glm::dmat4(1.0), lens});
            mMatrices.push_back(glm::translate(
                glm::dmat4(1.0),
                glm::dvec3(world.placeOf(rigid, time), 0.0, rigid == kWallRow ? -10.0 : -5.0)
            ));
        }
        mMovers = {{world.deformed, {}}, {rigid, mMatrices}};
        inputs.motion.keys = mKeys;
        inputs.motion.movers = mMovers;
        inputs.motion.rowCount = 2;
        return inputs;
    }

    static image::Image makeTruth(const World& world) {
        image::Image truth(kDeformedSize.width, kDeformedSize.height, 4);
        for (uint32_t y = 0; y < kDeformedSize.height; ++y)
            for (uint32_t x = 0; x < kDeformedSize.width; ++x)
                for (int i = 0; i < kDeformedInstants; ++i) {
                    const vec4 color = world.colorAt(x, y, (i + 0.5) / kDeformedInstants);
                    for (uint32_t channel = 0; channel < 4; ++channel)
                        truth.pixels[4 * (size_t{y} * kDeformedSize.width + x) + channel] +=
                            color[int(channel)] / kDeformedInstants;
                }
        return truth;
    }

    std::vector<HostCameraKey> mKeys;
    std::vector<glm::dmat4> mMatrices;
    std::vector<HostMover> mMovers;
    std::filesystem::path mFolder; ///< to dump to; empty: no dump
};

/// Brakes: 20 px in the first half of the exposure, 12 in the second.
constexpr World kBraking{[](double t) { return 40.0 + 32.0 * t - 16.0 * (t * t - 0.25); }};
/// A wall that waves slowly, and that the square uncovers.
constexpr World kUncovering{
    [](double t) { return 30.0 + 40.0 * t; }, [](double t) { return -7.0 * t; }, kWallRow};

TEST_F(EmbeddedDeformed, AWayThatBendsIsFollowedThroughTheRaster) {
    const image::Image truth = makeTruth(kBraking);
    const double bent = image::computePsnr(draw(kBraking, {.rasterTime = 0.5}), truth);
    const double straight = image::computePsnr(
        draw(kBraking, {.deformed = false, .lastDeformed = false, .rasterTime = 0.5}), truth
    );
    EXPECT_GT(bent, straight + 6.0);
    EXPECT_GT(bent, 30.0);
}

TEST_F(EmbeddedDeformed, UncoveredSurfacesAreFoundInTheLastRaster) {
    const image::Image truth = makeTruth(kUncovering);
    const double found = image::computePsnr(draw(kUncovering, {}), truth);
    const double guessed = image::computePsnr(draw(kUncovering, {.lastDeformed = false}), truth);
    EXPECT_GT(found, guessed + 6.0);
    EXPECT_GT(found, 30.0);
}

TEST_F(EmbeddedDeformed, DeformersWithoutMotionImagesAreNoWorseThanGathered) {
    for (const World& world : {kBraking, kUncovering}) {
        const image::Image truth = makeTruth(world);
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
    const Raster raster(device(), kUncovering, 1.0);
    HostInputs inputs = describe(kUncovering, raster, {.deformed = false});
    const test::Picture picture(device(), {kDeformedSize.width, kDeformedSize.height});
    inputs.output = picture.output();
    inputs.lastDeformedMotion = raster.deformed.describe();
    submit([&](VkCommandBuffer commands) {
        test::expectRefusal(
            mBlur->record(commands, 0, inputs, test::settingsOf("resolved")),
            "deformedMotion.image is null"
        );
    });
}

TEST_F(EmbeddedDeformed, ReplayGivesTheHostsPicture) {
    const test::TempFolder folder;
    mFolder = folder.path() / "dump";
    const image::Image picture = draw(kUncovering, {});
    replay::ReplayOptions options;
    options.folder = mFolder;
    options.out = folder.path() / "replayed.exr";
    const core::Status done = replay::replay(options, device());
    ASSERT_TRUE(done.ok()) << done.error().message;
    const auto replayed = io::readImage(folder.path() / "replayed_0001.exr");
    ASSERT_TRUE(replayed.ok()) << replayed.error().message;
    EXPECT_TRUE(test::sameBits(replayed.value(), picture));
}

} // namespace
} // namespace shutter
