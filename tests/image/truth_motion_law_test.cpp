// SPDX-License-Identifier: MIT
// Whatever moves, however: rays at any time and sharp frames at many times see the same.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

namespace shutter {
namespace {

using test::SceneBuilder;
using test::Stage;

class TruthMotionLaw : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }

    /// \param leastMoved dB: at most this near to the sharp picture, or nothing was tested
    void expectAgreement(const SceneBuilder& scene, double leastMoved = 40.0) {
        Stage stage(device(), scene);
        const test::Shot shot{
            .width = 64,
            .height = 48,
            .background = {0.1f, 0.2f, 0.3f},
            .ambient = math::vec3(0.2f),
            .instants = 256};
        const auto draw = [&](std::string_view method) {
            test::Shot one = shot;
            one.method = method;
            return stage.render(one).color;
        };
        const image::Image rays = draw("truth");
        EXPECT_TRUE(test::allFinite(rays));
        EXPECT_GE(image::computePsnr(rays, draw("accumulate")), 45.0);
        EXPECT_LE(image::computePsnr(rays, draw("sharp")), leastMoved)
            << "the motion shows in the picture";
    }
};

SceneBuilder makeRoom() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeQuad(8, 6, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    return scene;
}

scene::AssetIndex addLit(SceneBuilder& scene) {
    scene::Material material;
    material.baseColorFactor = {0.8f, 0.5f, 0.3f, 1.0f};
    material.roughnessFactor = 0.6f;
    material.metallicFactor = 0.0f;
    return scene.addMaterial(material);
}

TEST_F(TruthMotionLaw, ASpinOfMoreThanATurn) {
    SceneBuilder scene = makeRoom();
    scene.addSun({-0.3, -1.0, -0.8}, 2.0f);
    scene.add(
        test::makeBox({2.2, 0.3, 0.3}, addLit(scene)),
        {.position = {0, 0, -3}, .angularVelocity = {0.2, 0.5, 9.0}}
    );
    expectAgreement(scene);
}

TEST_F(TruthMotionLaw, ACameraThatMovesAndTurns) {
    SceneBuilder scene = makeRoom();
    scene.add(
        test::makeBox({0.4, 3, 0.4}, scene.addColor({0.9f, 0.2f, 0.1f})), {.position = {0.5, 0, -2}}
    );
    scene.moveCamera({.velocity = {0.2, 0.05, -0.3}, .angularVelocity = {0.02, 0.25, 0.1}});
    expectAgreement(scene);
}

TEST_F(TruthMotionLaw, AMovedAndSpinningChildOfASpinningParentUnderAMovingCamera) {
    SceneBuilder scene = makeRoom();
    const ecs::Entity parent = scene.add(
        test::makeBox({0.3, 0.3, 0.3}, scene.addColor({0.1f, 0.9f, 0.2f})),
        {.position = {0, 0, -3}, .velocity = {0.3, 0, 0}, .angularVelocity = {0, 0, 4}}
    );
    const ecs::Entity child = scene.add(
        test::makeBox({0.5, 0.2, 0.2}, scene.addColor({0.9f, 0.9f, 0.1f})),
        {.position = {0.8, 0, 0}, .angularVelocity = {0, 0, -7}}
    );
    scene.world.registry.add(child, scene::Parent{parent});
    scene.moveCamera({.angularVelocity = {0.0, 0.1, 0.0}});
    expectAgreement(scene);
}

TEST_F(TruthMotionLaw, AMirroredMoverKeepsItsSides) {
    SceneBuilder scene = makeRoom();
    scene.addSun({-0.3, -1.0, -0.8}, 2.0f);
    scene.add(
        test::makeBox({0.9, 0.5, 0.5}, addLit(scene)),
        {.position = {0, 0, -3},
         .scale = {-1, 1, 1.5},
         .velocity = {0.8, 0, 0},
         .angularVelocity = {1, 2, 0}}
    );
    expectAgreement(scene);
}

TEST_F(TruthMotionLaw, HolesOfAMaskedMover) {
    SceneBuilder scene = makeRoom();
    scene::Material material;
    material.unlit = true;
    material.alphaMode = scene::AlphaMode::Mask;
    material.baseColor.texture = scene.addWaveTexture(64, true);
    scene.add(
        test::makeQuad(2, 2, scene.addMaterial(material)),
        {.position = {-0.3, 0, -3}, .velocity = {0.7, 0.1, 0}}
    );
    expectAgreement(scene);
}

TEST_F(TruthMotionLaw, BlendedSurfacesBeforeAndBehindAMover) {
    SceneBuilder scene = makeRoom();
    const auto addGlass = [&](const math::vec4& color) {
        scene::Material glass;
        glass.unlit = true;
        glass.alphaMode = scene::AlphaMode::Blend;
        glass.baseColorFactor = color;
        return scene.addMaterial(glass);
    };
    scene.add(
        test::makeBox({0.6, 0.6, 0.6}, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0, 0, -3}, .velocity = {0.8, 0, 0}}
    );
    scene.add(test::makeQuad(1.5, 1, addGlass({0.1f, 0.3f, 0.9f, 0.4f})), {.position = {0, 0, -2}});
    scene.add(
        test::makeQuad(2, 1, addGlass({0.2f, 0.9f, 0.1f, 0.7f})),
        {.position = {0, 0.5, -4}, .velocity = {-0.5, 0, 0}}
    );
    expectAgreement(scene);
}

TEST_F(TruthMotionLaw, TheBackOfASingleSidedMoverIsNotSeen) {
    SceneBuilder scene = makeRoom();
    scene.add(
        test::makeQuad(2, 2, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0, 0, -3}, .angularVelocity = {0, 6, 0}}
    );
    expectAgreement(scene);
}

TEST_F(TruthMotionLaw, ALightThatMovesAndTurns) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(test::makeQuad(8, 6, addLit(scene)), {.position = {0, 0, -5}});
    const ecs::Entity lamp = scene.world.registry.create();
    scene::Light light;
    light.kind = scene::LightKind::Spot;
    light.intensity = 12.0f;
    light.outerConeAngle = 0.4f;
    scene.world.registry.add(lamp, light);
    math::Transform transform;
    transform.translation = {-1.0, 0.0, -3.0};
    scene.world.registry.add(lamp, scene::LocalTransform{transform});
    scene.world.registry.add(lamp, scene::LinearVelocity{{2.0, 0.3, 0.0}});
    scene.world.registry.add(lamp, scene::AngularVelocity{{0.4, 0.8, 0.0}});
    expectAgreement(scene, 45.0);
}

TEST_F(TruthMotionLaw, AMoverThatIsScaledToNothingAtTheRasterInstantIsSeenBefore) {
    SceneBuilder scene = makeRoom();
    const ecs::Entity box = scene.add(
        test::makeBox({1, 1, 1}, scene.addColor({0.9f, 0.2f, 0.1f})), {.position = {0, 0, -3}}
    );
    // From full size at open to nothing from the middle on, which is the raster instant.
    scene::AnimationChannel channel;
    channel.path = scene::AnimationPath::Scale;
    channel.times = {-0.5f, 0.0f};
    channel.values = {math::vec4(1.0f), math::vec4(0.0f)};
    scene::AnimationClip clip;
    clip.name = "shrink";
    clip.channels = {channel};
    scene.world.assets.clips.push_back(clip);
    scene.world.playback.activeClips.assign(1, true);
    scene.world.registry.add(box, scene::Animated{{{0, 0}}});
    expectAgreement(scene);
}

TEST_F(TruthMotionLaw, TheRaysOfTheRevealPassBlendedSurfaces) {
    SceneBuilder scene = makeRoom();
    scene.add(
        test::makeBox({0.6, 0.6, 0.6}, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0, 0, -3}, .velocity = {0.8, 0, 0}}
    );
    const auto without = test::renderOnce(device(), scene, {.method = "hybrid"});
    scene::Material glass;
    glass.unlit = true;
    glass.alphaMode = scene::AlphaMode::Blend;
    glass.baseColorFactor = {0.5f, 0.5f, 0.5f, 0.0f}; // invisible to raster
    scene.add(test::makeQuad(6, 5, scene.addMaterial(glass)), {.position = {0, 0, -4}});
    const auto with = test::renderOnce(device(), scene, {.method = "hybrid"});
    EXPECT_TRUE(test::sameBits(without.color, with.color));
}

} // namespace
} // namespace shutter
