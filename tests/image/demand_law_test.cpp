// SPDX-License-Identifier: MIT
// A frame pays for what it shows, and what it leaves out is not missing from the picture.
#include "engine/image/metrics.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <array>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::BlurBudget;
using motion_blur::MotionBlurPlugin;
using motion_blur::MotionBlurSettings;
using test::SceneBuilder;
using test::Shot;

class DemandLaw : public test::GpuTest {};

bool hasPass(const render::FrameResult& frame, const std::string& part) {
    const auto& passes = frame.statistics.passes;
    return std::any_of(passes.begin(), passes.end(), [&](const gpu::PassTime& pass) {
        return pass.name.find(part) != std::string::npos;
    });
}

/// A sphere that crosses before a wall of waves.
SceneBuilder makeCrossing() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const auto waves = scene.addTextured(scene.addWaveTexture());
    scene.add(test::makeQuad(9.0, 9.0, waves), {.position = {0, 0, -4}});
    scene.add(
        test::makeSphere(0.5, scene.addColor({1.0f, 0.4f, 0.1f})),
        {.position = {0, 0, -2}, .velocity = {0.5, 0.2, 0}}
    );
    return scene;
}

/// A sheet of waves beyond the borders of 120 pixels' height, that moves in pixels a second.
SceneBuilder makePan(const dvec3& velocity) {
    SceneBuilder scene;
    scene.setPixelView(120);
    const auto waves = scene.addTextured(scene.addWaveTexture());
    scene.add(test::makeQuad(900.0, 900.0, waves), {.position = {0, 0, -10}, .velocity = velocity});
    return scene;
}

Shot hybridShot() {
    return {
        .method = "hybrid",
        .width = 160,
        .height = 120,
        .background = math::vec3(0.2f, 0.3f, 0.4f),
        .aovs = {"mask"}};
}

/// Draws frame after frame with one effect, as a game does.
class Loop {
  public:
    Loop(
        gpu::Device& device,
        const SceneBuilder& scene,
        const MotionBlurSettings& settings,
        const BlurBudget& budget = {}
    )
        : mScene(scene), mRenderer(device, scene.world.assets),
          mBlur(device, mRenderer.scene(), settings, budget) {}

    render::FrameResult draw(double exposureSeconds) {
        render::FrameRequest request;
        scene::CameraShutter shutter;
        shutter.exposureSeconds = exposureSeconds;
        request.view.camera = mScene.camera;
        request.view.exposure = scene::computeExposure(shutter, 0.0, 1.0 / 24.0);
        request.view.width = 96;
        request.view.height = 64;
        request.wantReasons = true;
        const std::array<render::PostEffect*, 1> effects{&mBlur};
        auto frame = mRenderer.renderFrame(mScene.world, request, effects);
        EXPECT_TRUE(frame.ok());
        return frame.ok() ? std::move(frame).value() : render::FrameResult{};
    }

  private:
    const SceneBuilder& mScene;
    render::Renderer mRenderer;
    MotionBlurPlugin mBlur;
};

} // namespace

TEST_F(DemandLaw, BeforeTheSkyNoRayIsTracedAndThePictureIsTheSame) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeSphere(0.5, scene.addColor({1.0f, 0.4f, 0.1f})),
        {.position = {0, 0, -2}, .velocity = {0.5, 0.2, 0}}
    );
    const Shot shot = hybridShot();
    const auto frame = test::renderOnce(device(), scene, shot);
    EXPECT_GT(frame.statistics.counters.at("pixels masked"), 100u);
    EXPECT_EQ(frame.statistics.counters.at("rays traced"), 0u);
    EXPECT_FALSE(hasPass(frame, "TLAS"));
    EXPECT_TRUE(hasPass(frame, "sky reveal"));

    Shot traced = shot;
    traced.settings.revealTraversal = motion_blur::RevealTraversal::Stepping;
    const auto expected = test::renderOnce(device(), scene, traced);
    EXPECT_GT(expected.statistics.counters.at("rays traced"), 100u);
    EXPECT_TRUE(hasPass(expected, "TLAS"));
    EXPECT_TRUE(test::sameBits(frame.color, expected.color));
}

TEST_F(DemandLaw, WithoutRaysHybridIsSkippedBeforeTheSkyToo) {
    gpu::DeviceOptions options;
    options.validate = true;
    options.bestTier = gpu::RayTier::None;
    auto lower = gpu::Device::create(options);
    ASSERT_TRUE(lower.ok());
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeSphere(0.5, scene.addColor({1.0f, 0.4f, 0.1f})),
        {.position = {0, 0, -2}, .velocity = {0.5, 0.2, 0}}
    );
    MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("hybrid");
    const auto frame = Loop(*lower.value(), scene, settings).draw(1.0);
    EXPECT_NE(test::describeMotionBlur(frame).find("needs rays"), std::string::npos);
    EXPECT_EQ(lower.value()->validationMessageCount(), 0u);
}

TEST_F(DemandLaw, WhatNobodyWantsIsGivenBackAfterAWhile) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    const SceneBuilder scene = makeCrossing();
    MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("hybrid");
    Loop loop(device(), scene, settings);
    (void)loop.draw(0.0);
    (void)loop.draw(0.0);
    device().collect();
    const gpu::LivingObjects still = device().living();
    (void)loop.draw(0.5);
    // Pipelines and the read-back of counters stay; they know no picture's size.
    EXPECT_GT(device().living().accelerationStructures, still.accelerationStructures);
    // One more: what is retired goes when the next frame is done.
    for (uint32_t i = 0; i <= render::kFramesKept; ++i)
        (void)loop.draw(0.0);
    device().collect();
    EXPECT_EQ(device().living().accelerationStructures, still.accelerationStructures);
    EXPECT_EQ(device().living().images, still.images);
    const auto again = loop.draw(0.5);
    EXPECT_GT(again.statistics.counters.at("rays traced"), 0u);
}

TEST_F(DemandLaw, ATooSmallBudgetEndsWithTheCheapestBlurAndSaysSo) {
    const SceneBuilder scene = makeCrossing();
    MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("gather");
    const double last = double(motion_blur::makeLevels(settings).size() - 1);
    Loop loop(device(), scene, settings, {1e-6});
    render::FrameResult frame;
    for (int i = 0; i < 40; ++i) {
        frame = loop.draw(0.5);
        const auto* blur = render::findDecision(frame.statistics.explanations, "motion blur");
        ASSERT_NE(blur, nullptr);
        ASSERT_TRUE(blur->run) << "a budget took the blur away: " << blur->reason;
        EXPECT_GT(frame.statistics.measures.at("blur ms"), 0.0);
        const auto* budget = render::findDecision(frame.statistics.explanations, "blur budget");
        ASSERT_NE(budget, nullptr);
        EXPECT_EQ(budget->run, frame.statistics.measures.at("blur budget level") > 0.0);
    }
    EXPECT_EQ(frame.statistics.measures.at("blur budget level"), last);
    EXPECT_TRUE(hasPass(frame, "own velocity"));
    const auto* budget = render::findDecision(frame.statistics.explanations, "blur budget");
    EXPECT_NE(budget->reason.find("4 samples"), std::string::npos) << budget->reason;
    EXPECT_FALSE(test::sameBits(frame.color, loop.draw(0.0).color)) << "the picture is sharp";
}

TEST_F(DemandLaw, ABudgetOfPlentyChangesNoBit) {
    const SceneBuilder scene = makeCrossing();
    MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("gather");
    Loop limited(device(), scene, settings, {1e6});
    Loop unlimited(device(), scene, settings);
    for (int i = 0; i < 5; ++i)
        EXPECT_TRUE(test::sameBits(limited.draw(0.5).color, unlimited.draw(0.5).color));
}

TEST_F(DemandLaw, AQuarterOfTheRaysRevealsNearlyTheSame) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    const SceneBuilder scene = makeCrossing();
    const auto full = test::renderOnce(device(), scene, hybridShot());
    const auto& counted = full.statistics.counters;
    double last = 1.01;
    for (const float share : {1.0f, 0.6f, 0.25f, 0.1f, 0.0f}) {
        Shot shot = hybridShot();
        shot.settings.rayShare = share;
        const auto frame = test::renderOnce(device(), scene, shot);
        const auto rays = double(frame.statistics.counters.at("rays traced"));
        const double traced = rays / double(counted.at("rays traced"));
        // The rims of the mask have quads with few masked pixels.
        EXPECT_LE(traced, share + 0.2) << share;
        EXPECT_GE(traced, 0.6 * share) << share;
        EXPECT_LE(traced, last);
        last = traced;
        if (share >= 0.25f) {
            EXPECT_EQ(frame.statistics.counters.at("pixels masked"), counted.at("pixels masked"));
        }
        const double psnr = image::computePsnr(frame.color, full.color);
        if (share == 1.0f)
            EXPECT_TRUE(test::sameBits(frame.color, full.color));
        else
            EXPECT_GT(psnr, share >= 0.25f ? 40.0 : 25.0) << share;
        if (share == 0.0f) {
            Shot gather = hybridShot();
            gather.method = "gather";
            EXPECT_TRUE(test::sameBits(frame.color, test::renderOnce(device(), scene, gather).color)
            );
        }
    }
}

TEST_F(DemandLaw, HalfOfTheResolutionIsForSmearsAlongRowsAndColumns) {
    const SceneBuilder scene = makePan({20.0, 20.0, 0});
    Shot shot = hybridShot();
    shot.method = "gather";
    const auto full = test::renderOnce(device(), scene, shot);
    EXPECT_GT(full.statistics.counters.at("blocks uniform"), 200u);
    shot.settings.halfResolutionPx = 8.0f;
    EXPECT_TRUE(test::sameBits(test::renderOnce(device(), scene, shot).color, full.color));
}

TEST_F(DemandLaw, HalfOfTheResolutionAlongAPanIsHardToTell) {
    const SceneBuilder scene = makePan({24.0, 3.0, 0});
    Shot shot = hybridShot();
    shot.method = "gather";
    const auto full = test::renderOnce(device(), scene, shot);
    shot.settings.halfResolutionPx = 8.0f;
    const auto half = test::renderOnce(device(), scene, shot);
    EXPECT_FALSE(test::sameBits(half.color, full.color));
    EXPECT_GT(image::computePsnr(half.color, full.color), 40.0);
    shot.settings.halfResolutionPx = 100.0f; // longer than anything moves
    EXPECT_TRUE(test::sameBits(test::renderOnce(device(), scene, shot).color, full.color));
}

} // namespace shutter
