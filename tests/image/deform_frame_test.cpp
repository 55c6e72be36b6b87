// SPDX-License-Identifier: MIT
// What frames with deformed meshes do, and what frames without them do not.
#include "engine/image/metrics.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/truth/truth.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <array>
#include <map>
#include <string>
#include <utility>

namespace shutter {
namespace {

using math::dvec3;
using test::Placement;
using test::SceneBuilder;

class DeformFrame : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

/// A mover before a wall, and, where wanted, a strip that bends between them.
SceneBuilder makeScene(bool bends) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeQuad(7, 6, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    scene.add(
        test::makeQuad(0.5, 0.5, scene.addColor({1, 0, 0})),
        {.position = {0, 0, -2}, .velocity = {0.4, 0, 0}}
    );
    if (!bends)
        return scene;
    const std::array joints{
        Placement{.position = {0.1, -0.8, -3}},
        Placement{.position = {0, 0.8, 0}, .angularVelocity = {0.4, 0, 0.9}}};
    const scene::AssetIndex material = scene.addTextured(scene.addWaveTexture(), true);
    test::addSkinned(scene, test::makeStrip(0.9, 1.6, 12, material), joints);
    return scene;
}

/// Frames of one renderer, by hybrid.
class Frames {
  public:
    Frames(gpu::Device& device, const SceneBuilder& scene)
        : mScene(scene), mRenderer(device, scene.world.assets),
          mBlur(device, mRenderer.scene(), {.method = &motion_blur::getMethod("hybrid")}),
          mTruth(device, mRenderer.scene(), {}) {}

    render::FrameResult hybrid(double seconds) { return draw(seconds, &mBlur); }

    render::FrameResult truth(double seconds) {
        mTruth.setBatch(0, 4);
        return draw(seconds, &mTruth);
    }

    render::FrameResult sharp(double seconds) { return draw(seconds, nullptr); }

  private:
    render::FrameResult draw(double seconds, render::PostEffect* effect) {
        render::FrameRequest request;
        request.view.camera = mScene.camera;
        request.view.exposure = scene::computeExposure({0.5, scene::ShutterPhase::Centre}, seconds);
        request.view.width = 96;
        request.view.height = 64;
        request.wantDump = true;
        std::vector<render::PostEffect*> effects;
        if (effect)
            effects.push_back(effect);
        auto result = mRenderer.renderFrame(mScene.world, request, effects);
        EXPECT_TRUE(result.ok());
        return result ? std::move(result).value() : render::FrameResult{};
    }

    const SceneBuilder& mScene;
    render::Renderer mRenderer;
    motion_blur::MotionBlurPlugin mBlur;
    truth::Truth mTruth;
};

bool mentions(const render::FrameResult& frame, const std::string& words) {
    return frame.dump.find(words) != std::string::npos;
}

TEST_F(DeformFrame, WithoutDeformedMeshesNothingIsBent) {
    const SceneBuilder scene = makeScene(false);
    Frames frames(device(), scene);
    for (const auto& frame : {frames.sharp(0.0), frames.hybrid(0.0), frames.truth(0.0)}) {
        EXPECT_TRUE(mentions(frame, "G-buffer") || mentions(frame, "truth rays"));
        EXPECT_FALSE(mentions(frame, "deformed"));
        EXPECT_FALSE(mentions(frame, "bend"));
    }
}

TEST_F(DeformFrame, TimeSpentOnDeformedMeshesIsTheScenesAndNotTheBlurs) {
    using Owner = render::PassOwner;
    const SceneBuilder scene = makeScene(true);
    Frames frames(device(), scene);
    std::map<std::string, Owner> owners;
    for (const render::PassTime& pass : frames.hybrid(0.0).statistics.passes)
        owners[pass.name] = pass.owner;
    const std::pair<const char*, Owner> expected[] = {
        {"deform meshes", Owner::Scene},
        {"build deformed meshes", Owner::Rays},
        {"build TLAS", Owner::Rays},
        {"G-buffer", Owner::Scene},
        {"ray reveal", Owner::Blur},
        {"gather and composite", Owner::Blur},
        {"readback color", Owner::Display}};
    for (const auto& [name, owner] : expected) {
        ASSERT_TRUE(owners.contains(name)) << name;
        EXPECT_EQ(owners.at(name), owner) << name;
    }
}

TEST_F(DeformFrame, WithoutRaysNoLevelIsBuilt) {
    const SceneBuilder scene = makeScene(true);
    Frames frames(device(), scene);
    const auto frame = frames.sharp(0.0);
    EXPECT_TRUE(mentions(frame, "deform meshes"));
    EXPECT_FALSE(mentions(frame, "build deformed meshes"));
}

TEST_F(DeformFrame, AShapeThatIsLastFramesIsNotBuiltAgain) {
    const SceneBuilder scene = makeScene(true);
    Frames frames(device(), scene);
    const auto first = frames.hybrid(0.0);
    EXPECT_TRUE(mentions(first, "build deformed meshes"));
    const auto again = frames.hybrid(0.0);
    EXPECT_FALSE(mentions(again, "build deformed meshes"));
    EXPECT_TRUE(test::sameBits(first.color, again.color));
    EXPECT_TRUE(mentions(frames.hybrid(0.1), "build deformed meshes"));
}

TEST_F(DeformFrame, ARefittedShapeIsMetAsANewOneIs) {
    const SceneBuilder scene = makeScene(true);
    Frames frames(device(), scene);
    // Past one build from nothing on the way.
    for (uint32_t i = 0; i <= rays::kRefitsPerBuild + 3; ++i) {
        const double seconds = 0.05 * i;
        const auto refitted = frames.hybrid(seconds);
        EXPECT_TRUE(mentions(refitted, "build deformed meshes"));
        if (i % 6 != 5)
            continue;
        Frames fresh(device(), scene);
        EXPECT_TRUE(test::sameBits(refitted.color, fresh.hybrid(seconds).color)) << i;
    }
}

TEST_F(DeformFrame, TruthOfAnotherTimeIsNotTheLastOnes) {
    const SceneBuilder scene = makeScene(true);
    Frames frames(device(), scene);
    const auto early = frames.truth(0.0);
    const auto late = frames.truth(0.6);
    EXPECT_LT(image::computePsnr(early.color, late.color), 30.0);
    EXPECT_TRUE(test::sameBits(frames.truth(0.6).color, late.color)) << "kept shapes";
    EXPECT_TRUE(test::sameBits(frames.truth(0.0).color, early.color)) << "shapes made again";
    Frames fresh(device(), scene);
    EXPECT_TRUE(test::sameBits(fresh.truth(0.6).color, late.color));
}

TEST_F(DeformFrame, TheDenoisedRivalSeesWhatTruthSees) {
    const SceneBuilder scene = makeScene(true);
    test::Stage stage(device(), scene);
    const auto truth = stage.render({.method = "truth", .instants = 64});
    motion_blur::MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("denoised");
    render::Renderer renderer(device(), scene.world.assets);
    motion_blur::MotionBlurPlugin blur(device(), renderer.scene(), settings);
    render::FrameRequest request;
    request.view.camera = scene.camera;
    request.view.exposure = scene::computeExposure({1.0, scene::ShutterPhase::Centre}, 0.0);
    request.view.width = 96;
    request.view.height = 64;
    render::PostEffect* effects[] = {&blur};
    const auto denoised = renderer.renderFrame(scene.world, request, effects);
    ASSERT_TRUE(denoised.ok());
    EXPECT_GT(image::computePsnr(denoised.value().color, truth.color), 22.0);
}

TEST_F(DeformFrame, EntitiesThatComeAndGoLeaveTheOthersTheirShapes) {
    SceneBuilder scene = makeScene(true);
    const std::array joints{
        Placement{.position = {-0.8, -0.6, -3}},
        Placement{.position = {0, 0.6, 0}, .angularVelocity = {0, 0.5, -0.7}}};
    const auto second =
        test::addSkinned(scene, test::makeStrip(0.5, 1.2, 7, scene.addColor({0, 1, 0})), joints);
    Frames frames(device(), scene);
    (void)frames.hybrid(0.0);
    (void)frames.truth(0.0);
    scene.world.registry.remove<scene::MeshInstance>(second.entity);
    Frames fresh(device(), scene);
    EXPECT_TRUE(test::sameBits(frames.hybrid(0.1).color, fresh.hybrid(0.1).color));
    EXPECT_TRUE(test::sameBits(frames.truth(0.1).color, fresh.truth(0.1).color));
}

} // namespace
} // namespace shutter
