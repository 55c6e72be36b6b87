// SPDX-License-Identifier: MIT
// Ray-tracing pipelines: their tables, and that they reveal the same as ray queries.
#include "engine/gpu/ray_pipeline.h"
#include "game/shot/picture_drawer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

namespace shutter {
namespace {

using math::dvec3;

TEST(BindingTable, GroupsAreAlignedAsTheDeviceRequires) {
    // A device whose handles are tightly packed, one whose are not, and one with a wide base.
    for (const gpu::ShaderGroupLimits& limits :
         {gpu::ShaderGroupLimits{32, 32, 64},
          gpu::ShaderGroupLimits{32, 64, 64},
          gpu::ShaderGroupLimits{48, 32, 64},
          gpu::ShaderGroupLimits{32, 1, 4096}}) {
        const gpu::BindingTableLayout layout = gpu::computeTableLayout(limits);
        EXPECT_GE(layout.stride, limits.handleBytes);
        EXPECT_EQ(layout.stride % limits.handleAlignment, 0u);
        for (size_t i = 0; i < layout.offsets.size(); ++i) {
            EXPECT_EQ(layout.offsets[i] % limits.baseAlignment, 0u);
            const auto end = i + 1 < layout.offsets.size() ? layout.offsets[i + 1] : layout.bytes;
            EXPECT_GE(end - layout.offsets[i], layout.stride);
        }
    }
}

/// A second device of the tier below, which keeps its pipelines for all tests.
class RayPipelineTier : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        if (!device().info().hasRayPipeline || !device().hasRayQuery())
            GTEST_SKIP() << "the device lacks one of the tiers";
        if (!sLower)
            open("");
    }

    /// \param hidden feature
    static void open(const std::string& hidden) {
        gpu::DeviceOptions options;
        options.validate = true;
        options.bestTier = gpu::RayTier::Pipeline;
        options.wanted = device().info().name;
        options.keptPipelines = 64;
        auto opened = test::openFaulty(options, "SHUTTER_FAULT_HIDE", hidden);
        ASSERT_TRUE(opened.ok()) << opened.error().message;
        sLower = std::move(opened).value();
    }

    void TearDown() override {
        if (sLower) {
            sLower->waitIdle();
            EXPECT_EQ(sLower->validationMessageCount(), 0u);
            if (!sLower->info().tracesIndirect)
                sLower.reset(); // the other tests launch indirectly
        }
        GpuTest::TearDown();
    }

    static void TearDownTestSuite() { sLower.reset(); }

    gpu::Device& lower() { return *sLower; }

    /// Everything that the reveal writes, and the picture, are the same by both tiers. Hits are
    /// bit-identical on the software device; elsewhere a hit's place may differ by its rounding,
    /// which a half-float colour shows as 1/512 of it at most.
    void expectSamePictures(const test::SceneBuilder& scene, test::Shot shot, size_t leastMasked) {
        shot.method = "hybrid";
        shot.width = 96;
        shot.height = 64;
        shot.background = math::vec3(0.2f, 0.3f, 0.4f);
        shot.aovs = {"mask", "reveal", "reveal_motion", "reveal_id"};
        const auto queries = test::renderOnce(device(), scene, shot);
        const auto pipeline = test::renderOnce(lower(), scene, shot);
        const image::Image& mask = queries.intermediates.at("mask");
        EXPECT_GE(test::countSet(mask), leastMasked);
        EXPECT_EQ(queries.statistics.counters, pipeline.statistics.counters);
        const double bound = device().info().kind == "software" ? 0.0 : 1.0 / 512;
        const auto expectAlike = [&](const image::Image& a, const image::Image& b, const auto& where
                                 ) {
            EXPECT_LE(test::computeMaxDifferenceWhere(a, b, where), bound);
        };
        const auto everywhere = [](uint32_t, uint32_t) { return true; };
        expectAlike(queries.color, pipeline.color, everywhere);
        EXPECT_TRUE(test::sameBits(mask, pipeline.intermediates.at("mask")));
        // The rest is written where the mask is, and undefined elsewhere.
        const auto isMasked = [&](uint32_t x, uint32_t y) { return mask.at(x, y, 0) > 0.5f; };
        for (const char* aov : {"reveal", "reveal_motion"})
            if (bound == 0.0 || aov == std::string("reveal"))
                expectAlike(
                    queries.intermediates.at(aov), pipeline.intermediates.at(aov), isMasked
                );
        const image::Image& ids = queries.intermediates.at("reveal_id");
        size_t otherIds = 0;
        for (uint32_t y = 0; y < mask.height; ++y)
            for (uint32_t x = 0; x < mask.width; ++x)
                otherIds += isMasked(x, y) &&
                            ids.at(x, y, 0) != pipeline.intermediates.at("reveal_id").at(x, y, 0);
        EXPECT_TRUE(otherIds == 0 || bound > 0.0) << otherIds;
    }

    static inline std::unique_ptr<gpu::Device> sLower;
};

/// A mover of two shells before a pane, a leafy sheet, a mirrored box and a wall.
test::SceneBuilder makeScene() {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    const auto waves = scene.addTextured(scene.addWaveTexture());
    scene.add(test::makeQuad(7, 5, waves), {.position = {0, 0, -5}});
    scene.add(
        test::makeBox({1.0, 1.0, 0.4}, waves), {.position = {0.6, 0, -4}, .scale = {-1.2, 1, 1}}
    );
    scene::Material leaves;
    leaves.unlit = true;
    leaves.alphaMode = scene::AlphaMode::Mask;
    leaves.doubleSided = true;
    leaves.baseColor.texture = scene.addWaveTexture(64, true);
    scene.add(test::makeQuad(2, 2, scene.addMaterial(leaves)), {.position = {-0.6, 0.1, -3}});
    const auto pink = scene.addColor({1, 0, 0.9f});
    scene.world.assets.materials.back().doubleSided = true;
    const auto near = test::makeBox({0.9, 0.9, 0.1}, pink);
    const auto far = test::transformed(near, glm::translate(math::dmat4(1.0), dvec3(0, 0, -0.4)));
    scene.add(
        scene.addMesh({near, far}), {.position = {0.05, -0.03, -1.95}, .velocity = {0.35, 0.1, 0}}
    );
    return scene;
}

void addPane(test::SceneBuilder& scene) {
    scene::Material glass;
    glass.unlit = true;
    glass.alphaMode = scene::AlphaMode::Blend;
    glass.baseColorFactor = {0.2f, 0.9f, 0.4f, 0.4f};
    const auto material = scene.addMaterial(glass);
    scene.add(test::makeQuad(2.5, 2.5, material), {.position = {0.2, 0, -2.6}});
    scene.add(test::makeQuad(2.5, 2.5, material), {.position = {-0.2, 0, -1.5}});
}

TEST_F(RayPipelineTier, RayPipelinesRevealTheSameAsQueries) {
    EXPECT_TRUE(lower().hasRays());
    EXPECT_FALSE(lower().hasRayQuery());
    EXPECT_EQ(lower().info().rayTier, gpu::RayTier::Pipeline);
    test::SceneBuilder scene = makeScene();
    test::Shot shot;
    expectSamePictures(scene, shot, 150);
    shot.settings.revealTraversal = motion_blur::RevealTraversal::Stepping;
    expectSamePictures(scene, shot, 150);
    shot = {};
    shot.settings.objectTest = motion_blur::ObjectTest::Luminance;
    expectSamePictures(scene, shot, 150);
    addPane(scene);
    expectSamePictures(scene, {}, 150);
}

TEST_F(RayPipelineTier, DirectLaunchesRevealTheSameAsQueries) {
    open("rayTracingPipelineTraceRaysIndirect");
    EXPECT_FALSE(lower().info().tracesIndirect);
    expectSamePictures(makeScene(), {}, 150);
}

TEST_F(RayPipelineTier, RayPipelinesRevealTheSameAsQueriesWithMoreMoversThanMasks) {
    test::SceneBuilder scene = makeScene();
    scene.moveCamera({.velocity = {0.05, 0, 0}});
    const auto green = scene.addColor({0, 0.6f, 0});
    for (int i = 0; i < 60; ++i)
        scene.add(
            test::makeQuad(0.4, 0.4, green),
            {.position = {i % 10 * 0.5 - 2.25, i / 10 * 0.5 - 1.25, -4.5},
             .velocity = {0.1 * (i % 3), 0, 0}}
        );
    expectSamePictures(scene, {}, 150);
}

TEST_F(RayPipelineTier, AnEmptyMaskLaunchesNothing) {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeQuad(40, 40, scene.addWaves()), {.position = {0, 0, -4}, .velocity = {0.5, 0, 0}}
    );
    expectSamePictures(scene, {}, 0);
}

TEST_F(RayPipelineTier, MethodsThatNestQueriesAreRefusedAndHybridIsNot) {
    for (const game::MethodInfo& method : game::listMethods()) {
        const core::Status created =
            game::PictureDrawer::check(lower(), game::makeMethod(method), 64, 48);
        EXPECT_EQ(created.ok(), method.rays != game::RayNeed::Query) << method.name;
        if (created.ok())
            continue;
        EXPECT_NE(created.error().message.find(method.name), std::string::npos);
        EXPECT_NE(created.error().message.find("VK_KHR_ray_query"), std::string::npos);
    }
}

} // namespace
} // namespace shutter
