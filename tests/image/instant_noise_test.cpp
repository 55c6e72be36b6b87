// SPDX-License-Identifier: MIT
// Noise of the instants: grain in place of copies of an edge, only where there would be copies, and
// the same bits for the same frame.
#include "engine/image/metrics.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using motion_blur::InstantNoise;

constexpr uint32_t kWidth = 192;
constexpr uint32_t kHeight = 128;
constexpr double kWayPx = 120.0;

class InstantNoises : public test::GpuTest {
  protected:
    static test::Shot shotOf(std::string_view method, InstantNoise noise = InstantNoise::Off) {
        test::Shot shot{
            .method = method,
            .width = kWidth,
            .height = kHeight,
            .exposureSeconds = 1.0,
            .frameSeconds = 2.0,
            .instants = 240};
        shot.settings.instantNoise = noise;
        return shot;
    }

    /// A bright post two pixels wide that crosses a black picture.
    static test::SceneBuilder makePost(double wayPx = kWayPx) {
        test::SceneBuilder scene;
        scene.setPixelView(kHeight);
        scene.add(
            test::makeQuad(2.0, 2.0 * kHeight, scene.addColor(math::vec3(1.0f))),
            {.position = {0.0, 0.0, -10.0}, .velocity = {wayPx, 0.0, 0.0}}
        );
        return scene;
    }
};

/// Errors along the middle of the post's smear, as shares of its brightness.
struct SmearError {
    double banding = 0.0; ///< root mean square of the columns' means
    double noise = 0.0;   ///< ... of what is left without them
};

SmearError measureSmear(const image::Image& picture, const image::Image& truth) {
    const auto from = uint32_t(0.5 * (kWidth - 0.8 * kWayPx));
    double bright = 0.0;
    double banding = 0.0;
    double noise = 0.0;
    for (uint32_t x = from; x < kWidth - from; ++x) {
        double mean = 0.0;
        double squares = 0.0;
        for (uint32_t y = 0; y < kHeight; ++y) {
            const double error = double(picture.at(x, y, 0)) - double(truth.at(x, y, 0));
            mean += error / kHeight;
            squares += error * error / kHeight;
            bright += double(truth.at(x, y, 0)) / kHeight;
        }
        banding += mean * mean;
        noise += squares - mean * mean;
    }
    const double columns = kWidth - 2.0 * from;
    return {
        std::sqrt(banding / columns) * columns / bright,
        // Equal columns leave a difference of roundings, which may be negative.
        std::sqrt(std::max(noise, 0.0) / columns) * columns / bright};
}

/// Draws frames by number, in any order, with one renderer.
class Frames {
  public:
    Frames(gpu::Device& device, const test::SceneBuilder& scene)
        : mScene(scene), mRenderer(device, scene.world.assets),
          mBlur(device, mRenderer.scene(), {}) {}

    image::Image draw(int frame, InstantNoise noise) {
        motion_blur::MotionBlurSettings settings;
        settings.method = &motion_blur::getMethod("resolved");
        settings.history = false;
        settings.instantNoise = noise;
        mBlur.configure(settings, {});
        render::FrameRequest request;
        request.view.camera = mScene.camera;
        request.view.exposure = scene::computeExposure(
            {1.0, scene::ShutterPhase::Centre}, frame * kFrameSeconds, kFrameSeconds
        );
        request.view.width = kWidth;
        request.view.height = kHeight;
        render::PostEffect* effects[] = {&mBlur};
        auto drawn = mRenderer.renderFrame(mScene.world, request, effects);
        EXPECT_TRUE(drawn.ok());
        return drawn ? std::move(drawn.value().color) : image::Image();
    }

  private:
    static constexpr double kFrameSeconds = 1.0 / 30.0;

    const test::SceneBuilder& mScene;
    render::Renderer mRenderer;
    motion_blur::MotionBlurPlugin mBlur;
};

} // namespace

TEST_F(InstantNoises, APostThatGoesFarLeavesGrainInsteadOfCopies) {
    const test::SceneBuilder scene = makePost();
    const auto truth = test::renderOnce(device(), scene, shotOf("accumulate")).color;
    const auto plain =
        measureSmear(test::renderOnce(device(), scene, shotOf("resolved")).color, truth);
    EXPECT_GT(plain.banding, 1.0) << "the shot bands";
    EXPECT_LT(plain.noise, 0.01);
    for (const InstantNoise noise : {InstantNoise::Fixed, InstantNoise::Turning}) {
        const auto drawn = test::renderOnce(device(), scene, shotOf("resolved", noise));
        const SmearError error = measureSmear(drawn.color, truth);
        EXPECT_LT(error.banding, 0.3 * plain.banding);
        EXPECT_LT(error.noise, 1.1 * plain.banding) << "no more error than there was";
    }
}

TEST_F(InstantNoises, RaysTakeThemToo) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "adaptive needs ray queries";
    const test::SceneBuilder scene = makePost();
    const auto truth = test::renderOnce(device(), scene, shotOf("accumulate")).color;
    for (const float rays : {0.0f, 256.0f}) {
        test::Shot shot = shotOf("adaptive");
        shot.settings.raysPerPixel = rays;
        const auto plain = test::renderOnce(device(), scene, shot);
        shot.settings.instantNoise = InstantNoise::Fixed;
        const auto drawn = test::renderOnce(device(), scene, shot);
        EXPECT_LT(
            measureSmear(drawn.color, truth).banding, 0.3 * measureSmear(plain.color, truth).banding
        ) << rays;
    }
    test::Shot shot = shotOf("adaptive", InstantNoise::Fixed);
    shot.settings.raysPerPixel = 0.0f;
    EXPECT_TRUE(test::sameBits(
        test::renderOnce(device(), scene, shot).color,
        test::renderOnce(device(), scene, shotOf("resolved", InstantNoise::Fixed)).color
    ));
}

// Instants less than a pixel apart leave no copies.
TEST_F(InstantNoises, WhatMovesLittleHasNone) {
    const test::SceneBuilder scene = makePost(12.0);
    EXPECT_TRUE(test::sameBits(
        test::renderOnce(device(), scene, shotOf("resolved", InstantNoise::Fixed)).color,
        test::renderOnce(device(), scene, shotOf("resolved")).color
    ));
}

TEST_F(InstantNoises, ASurfaceOfOneColourKeepsIt) {
    test::SceneBuilder scene;
    scene.setPixelView(kHeight);
    scene.add(
        test::makeQuad(1000.0, 1000.0, scene.addColor({0.25f, 0.5f, 0.75f})),
        {.position = {0.0, 0.0, -10.0}, .velocity = {kWayPx, 0.5 * kWayPx, 0.0}}
    );
    const auto sharp = test::renderOnce(device(), scene, shotOf("sharp"));
    for (const float uniformMotionPx : {0.5f, 0.0f}) {
        test::Shot shot = shotOf("resolved", InstantNoise::Fixed);
        shot.settings.uniformMotionPx = uniformMotionPx;
        const auto drawn = test::renderOnce(device(), scene, shot);
        const auto anywhere = [](uint32_t, uint32_t) { return true; };
        EXPECT_LT(test::computeMaxDifferenceWhere(drawn.color, sharp.color, anywhere), 1.0e-3);
    }
}

// Blocks of one plane and pixels that search each for itself take the same instants.
TEST_F(InstantNoises, LooksOfBlocksAreThoseOfTheirPixels) {
    test::SceneBuilder scene;
    scene.setPixelView(kHeight);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(
        test::makeQuad(8.0 * kWidth, 8.0 * kWidth, waves),
        {.position = {0.0, 0.0, -10.0}, .velocity = {kWayPx, 0.3 * kWayPx, 0.0}}
    );
    test::Shot shot = shotOf("resolved", InstantNoise::Fixed);
    const auto together = test::renderOnce(device(), scene, shot);
    EXPECT_GT(together.statistics.counters.at("blocks uniform"), 0u);
    shot.settings.uniformMotionPx = 0.0f;
    const auto each = test::renderOnce(device(), scene, shot);
    EXPECT_GT(image::computePsnr(together.color, each.color), 45.0);
    shot.settings.sampleCount = 40; // more than blocks have looks for
    EXPECT_TRUE(test::allFinite(test::renderOnce(device(), scene, shot).color));
}

TEST_F(InstantNoises, AFrameHasTheSameBitsHoweverItWasReached) {
    const test::SceneBuilder scene = makePost();
    const std::vector<int> numbers = {-1, 0, 1, 2, 3};
    Frames whole(device(), scene);
    std::vector<image::Image> turning;
    std::vector<image::Image> fixed;
    for (const int number : numbers) {
        turning.push_back(whole.draw(number, InstantNoise::Turning));
        fixed.push_back(whole.draw(number, InstantNoise::Fixed));
    }
    Frames resumed(device(), scene); // as after a stop
    for (const size_t i : {3u, 1u, 0u}) {
        EXPECT_TRUE(test::sameBits(resumed.draw(numbers[i], InstantNoise::Turning), turning[i]));
        EXPECT_TRUE(test::sameBits(resumed.draw(numbers[i], InstantNoise::Fixed), fixed[i]));
    }
    EXPECT_TRUE(test::sameBits(turning[1], fixed[1])) << "frame 0 is not turned";
}

// The post is put where it was in each frame: only the noise differs.
TEST_F(InstantNoises, TurningHasOtherGrainInEachFrameWhichVanishesInTheMean) {
    test::SceneBuilder scene;
    scene.setPixelView(kHeight);
    const ecs::Entity post =
        scene.add(test::makeQuad(2.0, 2.0 * kHeight, scene.addColor(math::vec3(1.0f))), {});
    const auto draw = [&](int frame, test::Shot shot) {
        shot.seconds = frame * shot.frameSeconds;
        shot.settings.history = false;
        scene.place(
            post, {.position = {-kWayPx * shot.seconds, 0.0, -10.0}, .velocity = {kWayPx, 0.0, 0.0}}
        );
        return test::renderOnce(device(), scene, shot).color;
    };
    const test::Shot fixed = shotOf("resolved", InstantNoise::Fixed);
    const test::Shot turning = shotOf("resolved", InstantNoise::Turning);
    const auto first = draw(0, fixed);
    EXPECT_TRUE(test::sameBits(first, draw(1, fixed)));
    EXPECT_FALSE(test::sameBits(first, draw(1, turning)));
    const auto truth = draw(0, shotOf("accumulate"));
    constexpr int kFrames = 5;
    image::Image mean(kWidth, kHeight, first.channels);
    for (int frame = 0; frame < kFrames; ++frame) {
        const auto drawn = draw(frame, turning);
        for (size_t i = 0; i < mean.pixels.size(); ++i)
            mean.pixels[i] += drawn.pixels[i] / kFrames;
    }
    EXPECT_LT(measureSmear(mean, truth).noise, 0.4 * measureSmear(first, truth).noise);
}

} // namespace shutter
