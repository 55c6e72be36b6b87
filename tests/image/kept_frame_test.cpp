// SPDX-License-Identifier: MIT
// What a renderer keeps from frame to frame: rows, tables and top levels of what stands still.
#include "engine/rays/tlas.h"
#include "engine/scene/history.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using test::SceneBuilder;

class KeptFrames : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRays())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

/// A mover before `count` tiles of a wall, each an entity of its own.
struct Crowd {
    SceneBuilder scene;
    std::vector<ecs::Entity> tiles;
    ecs::Entity mover;

    explicit Crowd(size_t count) {
        scene.setPerspective(0.9);
        const auto material = scene.addTextured(scene.addWaveTexture());
        const auto tile = scene.addMesh({test::makeQuad(0.32, 0.3, material)});
        const auto glass = addGlass();
        for (size_t i = 0; i < count; ++i) {
            const dvec3 place(-3.2 + 0.34 * double(i % 20), -2.2 + 0.31 * double(i / 20), -5.0);
            tiles.push_back(scene.add(i % 16 == 15 ? glass : tile, {.position = place}));
        }
        mover = scene.add(
            test::makeQuad(0.6, 0.6, scene.addColor({1, 0, 0})),
            {.position = {-0.2, 0, -2}, .velocity = {0.5, 0.1, 0}}
        );
    }

    scene::AssetIndex addGlass() {
        scene::Material material;
        material.unlit = true;
        material.alphaMode = scene::AlphaMode::Blend;
        material.baseColorFactor = {0.2f, 0.6f, 0.9f, 0.5f};
        return scene.addMesh({test::makeQuad(0.32, 0.3, scene.addMaterial(material))});
    }

    math::Transform& transformOf(ecs::Entity entity) {
        return scene.world.registry.get<scene::LocalTransform>(entity).transform;
    }
};

/// Frames of one renderer.
class Frames {
  public:
    Frames(gpu::Device& device, const SceneBuilder& scene)
        : mScene(scene), mRenderer(device, scene.world.assets),
          mBlur(device, mRenderer.scene(), {.method = &motion_blur::getMethod("hybrid")}) {}

    render::FrameResult hybrid(double seconds, uint32_t width = 96) {
        render::FrameRequest request;
        request.view.camera = mScene.camera;
        request.view.exposure = scene::computeExposure({0.5, scene::ShutterPhase::Centre}, seconds);
        request.view.width = width;
        request.view.height = 64;
        request.intermediates = {"motion", "mesh_id"};
        std::array<render::PostEffect*, 1> effects{&mBlur};
        auto result = mRenderer.renderFrame(mScene.world, request, effects);
        EXPECT_TRUE(result.ok());
        return result ? std::move(result).value() : render::FrameResult{};
    }

  private:
    const SceneBuilder& mScene;
    render::Renderer mRenderer;
    motion_blur::MotionBlurPlugin mBlur;
};

bool ran(const render::FrameResult& frame, const std::string& pass) {
    const auto& passes = frame.statistics.passes;
    return std::any_of(passes.begin(), passes.end(), [&](const gpu::PassTime& time) {
        return time.name == pass;
    });
}

uint64_t rowsWritten(const render::FrameResult& frame) {
    return frame.statistics.counters.at("entity rows written");
}

uint64_t motionsWritten(const render::FrameResult& frame) {
    return frame.statistics.counters.at("entity motions written");
}

} // namespace

TEST_F(KeptFrames, AStillFrameWritesNeitherRowsNorMotionsAndBuildsNothing) {
    Crowd crowd(40);
    scene::hide(crowd.scene.world, crowd.mover);
    Frames frames(device(), crowd.scene);
    const auto first = frames.hybrid(0.0);
    EXPECT_EQ(rowsWritten(first), 40u);
    EXPECT_EQ(motionsWritten(first), 0u);
    const auto second = frames.hybrid(1.0);
    EXPECT_EQ(rowsWritten(second), 0u);
    EXPECT_EQ(motionsWritten(second), 0u);
    EXPECT_FALSE(ran(second, "build TLAS"));
    EXPECT_TRUE(test::sameBits(first.color, second.color));
}

TEST_F(KeptFrames, OnlyWhatMovesIsWritten) {
    const Crowd crowd(40);
    Frames frames(device(), crowd.scene);
    EXPECT_EQ(rowsWritten(frames.hybrid(0.0)), 41u);
    const auto second = frames.hybrid(0.1);
    EXPECT_EQ(rowsWritten(second), 1u);
    EXPECT_EQ(motionsWritten(second), 1u);
    EXPECT_TRUE(ran(second, "build TLAS")) << "the mover stands elsewhere";
    const auto paused = frames.hybrid(0.1);
    EXPECT_EQ(rowsWritten(paused), 0u);
    EXPECT_FALSE(ran(paused, "build TLAS")) << "no instance moved";
    EXPECT_TRUE(ran(paused, "ray reveal"));
    EXPECT_TRUE(test::sameBits(second.color, paused.color));
}

TEST_F(KeptFrames, ManyThatStandStillHaveATopLevelThatIsBuiltOnce) {
    Crowd crowd(rays::kStaticTlasInstances);
    Frames frames(device(), crowd.scene);
    const auto first = frames.hybrid(0.0);
    EXPECT_TRUE(ran(first, "build TLAS"));
    EXPECT_TRUE(ran(first, "build TLAS of movers"));
    const auto second = frames.hybrid(0.1);
    EXPECT_FALSE(ran(second, "build TLAS"));
    EXPECT_TRUE(ran(second, "build TLAS of movers"));
    crowd.transformOf(crowd.scene.camera).translation.x = 0.1;
    EXPECT_TRUE(ran(frames.hybrid(0.2), "build TLAS")) << "seen from another place";
}

TEST_F(KeptFrames, ATableThatMissedAFrameTakesAllRows) {
    const Crowd crowd(40);
    const gpu_scene::GpuScene scene(device(), crowd.scene.world.assets);
    extract::FrameExtractor extractor;
    gpu_scene::EntityTable table(device());
    const auto extract = [&](double seconds) -> extract::ExtractedFrame& {
        extract::ViewRequest view;
        view.camera = crowd.scene.camera;
        view.exposure = scene::computeExposure({0.5, scene::ShutterPhase::Centre}, seconds);
        return *extractor.update(crowd.scene.world, scene.layout(), view).value();
    };
    EXPECT_EQ(table.update(extract(0.0)).rows, 41u);
    EXPECT_EQ(table.update(extract(0.1)).rows, 1u);
    (void)extract(0.2);
    EXPECT_EQ(table.update(extract(0.3)).rows, 41u);
    extract::ExtractedFrame& longer = extract(0.4);
    longer.entities.emplace_back();
    EXPECT_EQ(table.update(longer).rows, 2u) << "what was appended is this frame's only";
    EXPECT_EQ(table.update(extract(0.5)).rows, 1u);
}

TEST_F(KeptFrames, PicturesAreThoseOfARendererThatKeptNothing) {
    for (const size_t count : {size_t{60}, rays::kStaticTlasInstances + 40}) {
        Crowd crowd(count);
        scene::World& world = crowd.scene.world;
        const std::array joints{
            test::Placement{.position = {0.6, -0.8, -3}},
            test::Placement{.position = {0, 0.8, 0}, .angularVelocity = {0.4, 0, 0.9}}};
        const auto strip = crowd.scene.addTextured(crowd.scene.addWaveTexture(), true);
        test::addSkinned(crowd.scene, test::makeStrip(0.5, 1.6, 8, strip), joints);
        double seconds = 0.0;
        uint32_t width = 96;
        const std::vector<std::function<void()>> edits{
            [] {},
            [&] { seconds = 0.1; },
            [&] { crowd.transformOf(crowd.tiles[25]).translation.z = -3.0; },
            [&] { crowd.transformOf(crowd.tiles[25]).translation.z = -2.5; },
            [&] { scene::hide(world, crowd.tiles[30]); },
            [&] {
                crowd.transformOf(crowd.scene.camera).translation = {0.1, 0.1, 0.2};
            },
            [&] {
                world.registry.add(crowd.scene.camera, scene::LinearVelocity{{0.2, 0, 0}});
            },
            [&] { seconds = 0.15; },
            [&] { world.registry.remove<scene::LinearVelocity>(crowd.scene.camera); },
            [&] { scene::despawn(world, crowd.tiles[3]); },
            [&] { scene::show(world, crowd.tiles[30], 0.0); },
            [&] { width = 112; },
            [&] { scene::despawn(world, crowd.mover); }};
        Frames kept(device(), crowd.scene);
        for (size_t i = 0; i < edits.size(); ++i) {
            edits[i]();
            const auto frame = kept.hybrid(seconds, width);
            Frames fresh(device(), crowd.scene);
            const auto expected = fresh.hybrid(seconds, width);
            EXPECT_TRUE(test::sameBits(frame.color, expected.color)) << count << ", edit " << i;
            for (const auto& [name, image] : expected.intermediates)
                EXPECT_TRUE(test::sameBits(frame.intermediates.at(name), image)) << name << i;
        }
    }
}

} // namespace shutter
