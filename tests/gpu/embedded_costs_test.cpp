// SPDX-License-Identifier: MIT
// What each convention of inputs costs, and whether its picture is as close to the truth as that of
// the module's own images. SHUTTER_EMBEDDED_COSTS=ROUNDS measures times as well, and prints
// both as a table (docs/embedding.md).
#include "assets/generator/scenes.h"
#include "engine/gpu/frame.h"
#include "engine/image/metrics.h"
#include "game/shot/methods.h"
#include "game/shot/picture_drawer.h"
#include "shaders/motion_blur/prepare.glsl"
#include "shaders/render/scene_shared.h"
#include "tests/gpu/checked_shot.h"
#include "tests/gpu/host_texels.h"
#include "tests/support/picture.h"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using motion_blur::HostImage;
using motion_blur::HostInputs;

constexpr double kExposureSeconds = 1.0 / 60.0;
constexpr double kSeconds = 0.05; ///< of the raster instant
constexpr uint32_t kTruthInstants = 128;
constexpr double kExactDb = 0.05;
constexpr double kRoundedDb = 0.15; ///< halves hold 1/2048 of a vector's length

/// The raster of a shot; vectors and cameras are over its exposure.
struct Raster {
    std::vector<glm::vec4> color;
    std::vector<glm::vec2> motion;
    std::vector<float> metres;
    motion_blur::HostCameras cameras;
};

uint32_t readRounds() {
    const char* rounds = std::getenv("SHUTTER_EMBEDDED_COSTS");
    return rounds ? uint32_t(std::max(std::atoi(rounds), 1)) : 0;
}

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[size_t(share * double(values.size() - 1) + 0.5)];
}

class EmbeddedCosts : public test::EmbeddedTest {
  protected:
    struct Convention {
        std::string name;
        std::function<void(HostInputs&)> apply;
        /// How far its picture's PSNR may be from that of the native one, dB; 0: no claim is made.
        double claimDb = 0.0;
        std::vector<double> milliseconds{};
    };

    void SetUp() override {
        EmbeddedTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        mSize = readRounds() > 0 ? math::uvec2(640, 360) : math::uvec2(320, 180);
        mRaster = drawRaster(kExposureSeconds, true);
        mFrame = drawRaster(2.0 * kExposureSeconds, false);
        motion_blur::HostDevice host = describeHost();
        host.measures = true;
        mBlur = create(host);
    }

    void TearDown() override {
        mTexels.clear();
        mBlur.reset();
        EmbeddedTest::TearDown();
    }

    Raster drawRaster(double exposureSeconds, bool drawsTruth) {
        const char* keys =
            R"({"version": 1, "name": "costs", "fps": 30, "keys": [)"
            R"({"time": 0, "position": [0.5, 1.7, 7.0], "lookAt": [0, 1.5, 0], "fieldOfView": 40},)"
            R"({"time": 0.1, "position": [0.8, 1.8, 6.6], "lookAt": [0.6, 1.6, 0], "fieldOfView": 40}]})";
        const auto shot = test::loadCheckedShot(
            {"costs", &generator::buildCourtyardScene, {}, keys}, mSize, exposureSeconds
        );
        EXPECT_TRUE(shot.ok()) << shot.error().message;
        render::Renderer renderer(device(), shot.value().shot.world.assets);
        render::FrameRequest request;
        request.view = game::makeView(shot.value().shot, shot.value().options, kSeconds);
        request.intermediates = {"motion"};
        const auto drawn = renderer.renderFrame(shot.value().shot.world, request, {});
        EXPECT_TRUE(drawn.ok());
        Raster raster;
        const image::Image& motion = drawn.value().intermediates.at("motion");
        for (size_t i = 0; i < size_t{mSize.x} * mSize.y; ++i) {
            glm::vec4 color;
            std::memcpy(&color, &drawn.value().color.pixels[4 * i], sizeof(color));
            raster.color.push_back(color);
            raster.motion.emplace_back(motion.pixels[4 * i], motion.pixels[4 * i + 1]);
            raster.metres.push_back(motion.pixels[4 * i + 2]);
        }
        raster.cameras = test::tellCameras(shot.value().shot.world, request.view);
        if (drawsTruth)
            drawTruth(renderer, shot.value());
        return raster;
    }

    void drawTruth(render::Renderer& renderer, const test::CheckedShot& shot) {
        game::MethodOptions method = game::makeMethod(*game::findMethod("accumulate").value());
        method.samples = kTruthInstants;
        game::PictureDrawer drawer(device(), renderer);
        auto truth = drawer.draw(
            shot.shot.world, game::makePicture(shot.shot, shot.options, method, kSeconds)
        );
        ASSERT_TRUE(truth.ok()) << truth.error().message;
        mTruth = std::move(truth.value().color);
    }

    /// \param change of each value, to a texel
    template <class Values, class Change>
    HostImage make(VkFormat format, const Values& values, const Change& change) {
        using Texel = decltype(change(values.front()));
        std::vector<Texel> texels;
        for (const auto& value : values)
            texels.push_back(change(value));
        return mTexels.emplace_back(device(), format, extent(), test::bytesOf(texels)).describe();
    }

    [[nodiscard]] VkExtent2D extent() const { return {mSize.x, mSize.y}; }

    HostImage makeVectors(VkFormat format, const Raster& raster, const glm::vec2& scale) {
        if (format == VK_FORMAT_R16G16_SFLOAT)
            return make(format, raster.motion, [&](const glm::vec2& motion) {
                return glm::packHalf2x16(motion * scale);
            });
        return make(format, raster.motion, [&](const glm::vec2& motion) { return motion * scale; });
    }

    /// As a reversed infinite projection stores it.
    HostImage makeRawDepth(VkFormat format) {
        const auto near = float(mRaster.cameras.clipFromView[3].z);
        const auto store = [&](float metres) {
            return metres >= shader::kSkyDepth ? 0.0f : near / metres;
        };
        if (format == VK_FORMAT_D16_UNORM)
            return make(format, mRaster.metres, [&](float metres) {
                return uint16_t(std::min(store(metres), 1.0f) * 65535.0f + 0.5f);
            });
        return make(format, mRaster.metres, store);
    }

    /// Vectors of full floats over the exposure, depth as the hardware stores it, cameras.
    void useConvention(HostInputs& inputs) {
        inputs.motionDepth = {};
        auto& convention = inputs.convention;
        convention.vectors.image = makeVectors(VK_FORMAT_R32G32_SFLOAT, mRaster, glm::vec2(1.0f));
        convention.depth.image = makeRawDepth(VK_FORMAT_D32_SFLOAT);
        convention.cameras = mRaster.cameras;
        convention.scales.exposureShare = 1.0f;
    }

    void useVectors(HostInputs& inputs, VkFormat format, const glm::vec2& pixelsPerUnit) {
        useConvention(inputs);
        inputs.convention.vectors.pixelsPerUnit = pixelsPerUnit;
        inputs.convention.vectors.image = makeVectors(format, mRaster, 1.0f / pixelsPerUnit);
    }

    /// Vectors of what moves by itself; the camera's part comes from depth.
    void useObjectVectors(HostInputs& inputs) {
        useConvention(inputs);
        motion_blur::HostConvention& convention = inputs.convention;
        convention.vectors = {};
        const shader::PrepareTable table = motion_blur::makePrepareTable(convention, extent());
        Raster objects = mRaster;
        for (size_t i = 0; i < objects.motion.size(); ++i) {
            const glm::vec2 place(float(i % mSize.x) + 0.5f, float(i / mSize.x) + 0.5f);
            const glm::vec2 own =
                objects.motion[i] - shader::motionOfCamera(table, place, objects.metres[i]);
            objects.motion[i] = glm::length(own) < 0.01f ? glm::vec2(0.0f) : own;
        }
        convention.vectors.lackCamera = true;
        convention.vectors.image = makeVectors(VK_FORMAT_R16G16_SFLOAT, objects, glm::vec2(1.0f));
    }

    std::vector<Convention> listConventions();
    void draw(Convention& convention, image::Image* picture);

    math::uvec2 mSize{0u};
    Raster mRaster;
    Raster mFrame; ///< over a frame, which is two exposures
    image::Image mTruth;
    std::unique_ptr<motion_blur::EmbeddedMotionBlur> mBlur;
    std::deque<test::HostTexels> mTexels;
};

std::vector<EmbeddedCosts::Convention> EmbeddedCosts::listConventions() {
    const glm::vec2 size(mSize);
    constexpr VkFormat kHalves = VK_FORMAT_R16G16_SFLOAT;
    const auto named = [&](std::string name, auto apply, double claimDb = kExactDb) {
        return Convention{std::move(name), apply, claimDb};
    };
    return {
        named("`motionDepth`, the module's own", [](HostInputs&) {}),
        named("RG32F pixels, D32", [&](HostInputs& in) { useConvention(in); }),
        named(
            "RG16F pixels",
            [&](HostInputs& in) { useVectors(in, kHalves, glm::vec2(1.0f)); },
            kRoundedDb
        ),
        named(
            "RG16F texture coordinates",
            [&](HostInputs& in) { useVectors(in, kHalves, -size); },
            kRoundedDb
        ),
        named(
            "RG16F normalised coordinates, y up",
            [&](HostInputs& in) {
                useVectors(in, kHalves, {-0.5f * size.x, 0.5f * size.y});
            },
            kRoundedDb
        ),
        named(
            "vectors over a frame of two exposures",
            [&](HostInputs& in) {
                useConvention(in);
                in.convention.vectors.image = makeVectors(kHalves, mFrame, glm::vec2(1.0f));
                in.convention.cameras = mFrame.cameras;
                in.convention.scales.exposureShare = 0.5f;
            },
            0.0
        ),
        named("camera's part added from depth", [&](HostInputs& in) { useObjectVectors(in); }),
        named(
            "D16",
            [&](HostInputs& in) {
                useConvention(in);
                in.convention.depth.image = makeRawDepth(VK_FORMAT_D16_UNORM);
            }
        ),
        named(
            "linear depth, R16F",
            [&](HostInputs& in) {
                useConvention(in);
                in.convention.depth.isLinear = true;
                in.convention.depth.skyValue = shader::kSkyDepth;
                in.convention.depth.image =
                    make(VK_FORMAT_R16_SFLOAT, mRaster.metres, [](float metres) {
                        return glm::packHalf1x16(metres);
                    });
            }
        ),
        named(
            "share of the blur per pixel, R8",
            [&](HostInputs& in) {
                useConvention(in);
                in.convention.scales.perPixel =
                    make(VK_FORMAT_R8_UNORM, mRaster.metres, [](float) { return uint8_t{255}; });
            }
        ),
        named(
            "`color` in RGBA32F",
            [&](HostInputs& in) {
                in.color = make(VK_FORMAT_R32G32B32A32_SFLOAT, mRaster.color, [](auto& color) {
                    return color;
                });
            }
        ),
        named(
            "`color` in B10G11R11",
            [&](HostInputs& in) {
                in.color =
                    make(VK_FORMAT_B10G11R11_UFLOAT_PACK32, mRaster.color, [](const auto& color) {
                        return glm::packF2x11_1x10(glm::vec3(color));
                    });
            },
            0.0
        )};
}

void EmbeddedCosts::draw(Convention& convention, image::Image* picture) {
    mTexels.clear();
    HostInputs inputs;
    inputs.width = mSize.x;
    inputs.height = mSize.y;
    inputs.color = make(VK_FORMAT_R16G16B16A16_SFLOAT, mRaster.color, test::packHalf);
    std::vector<glm::vec4> packed;
    for (size_t i = 0; i < mRaster.motion.size(); ++i)
        packed.emplace_back(mRaster.motion[i], mRaster.metres[i], 0.0f);
    inputs.motionDepth =
        make(VK_FORMAT_R32G32B32A32_SFLOAT, packed, [](const auto& texel) { return texel; });
    convention.apply(inputs);
    const test::Picture output(device(), "output", mSize);
    inputs.output = {output.handle(), test::kNothing, test::kCopied};
    gpu::Frame frame(device());
    frame.begin();
    for (const test::HostTexels& texels : mTexels)
        texels.record(frame.commands());
    const core::Status done = mBlur->record(frame.commands(), 0, inputs, test::gather());
    ASSERT_TRUE(done.ok()) << done.error().message;
    output.recordReadback(frame.commands());
    frame.submit();
    frame.wait();
    const auto report = mBlur->report(0);
    ASSERT_TRUE(report.ok()) << report.error().message;
    convention.milliseconds.push_back(report.value().milliseconds);
    if (picture)
        *picture = output.read();
}

TEST_F(EmbeddedCosts, EachConventionIsAsCloseToTheTruthAsTheNativeOne) {
    std::vector<Convention> all = listConventions();
    std::vector<double> decibels;
    for (Convention& one : all) { // the first frame makes pipelines: its time does not count
        image::Image picture;
        draw(one, &picture);
        ASSERT_FALSE(HasFatalFailure()) << one.name;
        one.milliseconds.clear();
        decibels.push_back(image::computePsnr(picture, mTruth));
        if (one.claimDb > 0.0) {
            EXPECT_NEAR(decibels.back(), decibels.front(), one.claimDb) << one.name;
        }
    }
    const uint32_t rounds = readRounds();
    for (uint32_t round = 0; round < rounds; ++round)
        for (Convention& one : all)
            draw(one, nullptr);
    if (rounds == 0)
        return;
    const double native = quantile(all.front().milliseconds, 0.5);
    for (size_t i = 0; i < all.size(); ++i) {
        const auto at = [&](double share) { return quantile(all[i].milliseconds, share); };
        fmt::print(
            "| {} | {:.2f} | {:.2f} (±{:.2f}) | {:+.3f} |\n",
            all[i].name,
            at(0.5),
            at(0.5) / native,
            0.5 * (at(0.75) - at(0.25)) / native,
            decibels[i] - decibels.front()
        );
    }
    fmt::print("native: {:.2f} dB; {} rounds, {} x {}\n", decibels[0], rounds, mSize.x, mSize.y);
}

} // namespace
} // namespace shutter
