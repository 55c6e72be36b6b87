// SPDX-License-Identifier: MIT
// What a renderer keeps from frame to frame, and frames that the CPU submits before the GPU is done
// with those before.
#include "engine/rays/tlas.h"
#include "engine/scene/history.h"
#include "engine/scene/particle_emitter.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using test::SceneBuilder;

class KeptFrame : public test::RayTest {};

class KeptFrames : public test::Frames {
  public:
    using Frames::Frames;

    render::FrameResult hybrid(double seconds, uint32_t width = 96) {
        return draw(
            {.method = "hybrid",
             .width = width,
             .seconds = seconds,
             .exposureSeconds = 0.5,
             .aovs = {"motion", "mesh_id"}}
        );
    }
};

void expectWritten(const render::FrameResult& frame, uint64_t rows, uint64_t motions) {
    EXPECT_EQ(frame.statistics.counters.at("entity rows written"), rows);
    EXPECT_EQ(frame.statistics.counters.at("entity motions written"), motions);
}

/// A mover in front of `count` tiles of a wall, each a separate entity.
struct Crowd {
    SceneBuilder scene;
    std::vector<ecs::Entity> tiles;
    ecs::Entity mover;

    explicit Crowd(size_t count) {
        scene.setPerspective(0.9);
        const auto material = scene.addWaves();
        const auto tile = scene.addMesh({test::makeQuad(0.32, 0.3, material)});
        scene::Material pane;
        pane.unlit = true;
        pane.alphaMode = scene::AlphaMode::Blend;
        pane.baseColorFactor = {0.2f, 0.6f, 0.9f, 0.5f};
        const auto glass = scene.addMesh({test::makeQuad(0.32, 0.3, scene.addMaterial(pane))});
        for (size_t i = 0; i < count; ++i) {
            const dvec3 place(-3.2 + 0.34 * double(i % 20), -2.2 + 0.31 * double(i / 20), -5.0);
            tiles.push_back(scene.add(i % 16 == 15 ? glass : tile, {.position = place}));
        }
        mover = scene.add(
            test::makeQuad(0.6, 0.6, scene.addColor({1, 0, 0})),
            {.position = {-0.2, 0, -2}, .velocity = {0.5, 0.1, 0}}
        );
    }

    math::Transform& transformOf(ecs::Entity entity) {
        return scene.world.registry.get<scene::LocalTransform>(entity).transform;
    }
};

TEST_F(KeptFrame, AStillFrameWritesNeitherRowsNorMotionsAndBuildsNothing) {
    Crowd crowd(40);
    scene::hide(crowd.scene.world, crowd.mover);
    KeptFrames frames(device(), crowd.scene);
    const auto first = frames.hybrid(0.0);
    expectWritten(first, 40, 0);
    const auto second = frames.hybrid(1.0);
    expectWritten(second, 0, 0);
    EXPECT_FALSE(test::hasPass(second, "build TLAS"));
    EXPECT_TRUE(test::sameBits(first.color, second.color));
}

TEST_F(KeptFrame, OnlyMovingRowsAreWritten) {
    const Crowd crowd(40);
    KeptFrames frames(device(), crowd.scene);
    expectWritten(frames.hybrid(0.0), 41, 1);
    const auto second = frames.hybrid(0.1);
    expectWritten(second, 1, 1);
    EXPECT_TRUE(test::hasPass(second, "build TLAS")) << "the mover stands elsewhere";
    const auto paused = frames.hybrid(0.1);
    expectWritten(paused, 0, 1);
    EXPECT_FALSE(test::hasPass(paused, "build TLAS")) << "no instance moved";
    EXPECT_TRUE(test::hasPass(paused, "ray reveal"));
    EXPECT_TRUE(test::sameBits(second.color, paused.color));
}

TEST_F(KeptFrame, ManyStaticInstancesHaveATlasThatIsBuiltOnce) {
    Crowd crowd(rays::kStaticTlasInstances);
    KeptFrames frames(device(), crowd.scene);
    const auto first = frames.hybrid(0.0);
    EXPECT_TRUE(test::hasPass(first, "build TLAS"));
    EXPECT_TRUE(test::hasPass(first, "build TLAS of movers"));
    const auto second = frames.hybrid(0.1);
    EXPECT_FALSE(test::hasPass(second, "build TLAS"));
    EXPECT_TRUE(test::hasPass(second, "build TLAS of movers"));
    crowd.transformOf(crowd.scene.camera).translation.x = 0.1;
    EXPECT_TRUE(test::hasPass(frames.hybrid(0.2), "build TLAS")) << "seen from another place";
}

TEST_F(KeptFrame, ATableThatMissedAFrameTakesAllRows) {
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

TEST_F(KeptFrame, PicturesAreThoseOfARendererThatKeptNothing) {
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
        KeptFrames kept(device(), crowd.scene);
        for (size_t i = 0; i < edits.size(); ++i) {
            edits[i]();
            const auto frame = kept.hybrid(seconds, width);
            KeptFrames fresh(device(), crowd.scene);
            const auto expected = fresh.hybrid(seconds, width);
            EXPECT_TRUE(test::sameBits(frame.color, expected.color)) << count << ", edit " << i;
            for (const auto& [name, image] : expected.intermediates)
                EXPECT_TRUE(test::sameBits(frame.intermediates.at(name), image)) << name << i;
        }
    }
}

constexpr int kFrames = 9;

struct Sequence {
    std::vector<image::Image> colors;
    std::vector<render::Counters> counters;
};

Sequence draw(gpu::Device& device, const std::string& method, uint32_t framesInFlight) {
    // The mover comes and goes, under a camera that moves, a pane crosses it, and sparks fly.
    Crowd crowd(40);
    crowd.scene.moveCamera({.velocity = {0.1, 0, 0}});
    scene::Material glass;
    glass.unlit = true;
    glass.alphaMode = scene::AlphaMode::Blend;
    glass.baseColorFactor = {0.1f, 0.9f, 0.4f, 0.6f};
    crowd.scene.add(
        test::makeQuad(0.5, 0.4, crowd.scene.addMaterial(glass)),
        {.position = {0.1, 0.1, -1.5}, .velocity = {-1.0, 0.2, 0}, .angularVelocity = {0, 0, 2}}
    );
    scene::World& world = crowd.scene.world;
    const ecs::Entity sparks = world.registry.create();
    math::Transform place;
    place.translation = {0.0, 0.0, -2.0};
    world.registry.add(sparks, scene::LocalTransform{place});
    scene::ParticleEmitter emitter;
    emitter.spans = {{.fromSeconds = -1.0, .untilSeconds = 1.0, .perSecond = 60.0}};
    emitter.lifeSeconds = 0.3;
    emitter.velocity = {0.0, 1.0, 0.0};
    emitter.coneDegrees = 90.0;
    world.registry.add(sparks, emitter);
    render::Renderer renderer(device, world.assets, framesInFlight);
    motion_blur::MotionBlurPlugin blur(
        device, renderer.scene(), {.method = &motion_blur::getMethod(method)}
    );
    std::array<render::PostEffect*, 1> effects{&blur};
    Sequence sequence;
    const auto finish = [&] {
        render::FrameResult result = renderer.finishFrame();
        sequence.colors.push_back(std::move(result.color));
        // The number of written rows and the reused data depend on the frames in flight.
        for (const char* own : {"entity rows written", "entity motions written", "history bytes"})
            result.statistics.counters.erase(own);
        sequence.counters.push_back(result.statistics.counters);
    };
    for (int i = 0; i < kFrames; ++i) {
        if (i == 3)
            scene::hide(world, crowd.mover);
        if (i == 6)
            scene::show(world, crowd.mover, 0.05 * i);
        if (renderer.unfinishedCount() == framesInFlight)
            finish();
        render::FrameRequest request;
        request.view.camera = crowd.scene.camera;
        request.view.exposure =
            scene::computeExposure({0.25, scene::ShutterPhase::Centre}, 0.05 * i);
        // The picture changes its size on the way.
        request.view.width = i < 5 ? 96 : 80;
        request.view.height = 64;
        EXPECT_TRUE(renderer.submitFrame(world, request, effects).ok());
    }
    while (renderer.unfinishedCount() > 0)
        finish();
    return sequence;
}

class FramesInFlight : public test::RayTest {};

TEST_F(FramesInFlight, OverlappingFramesGiveThePicturesAndCountersOfSequentialOnes) {
    for (const std::string method : {"hybrid", "resolved"}) {
        const Sequence alone = draw(device(), method, 1);
        ASSERT_EQ(alone.colors.size(), size_t{kFrames});
        if (method == "hybrid") {
            EXPECT_GT(alone.counters[2].at("pixels masked"), 100u);
        }
        EXPECT_GT(alone.counters[2].at("blended instants"), 1u);
        EXPECT_NE(alone.counters[2], alone.counters[4]);
        for (const uint32_t count : {2u, gpu::kMaxFramesInFlight}) {
            const Sequence ahead = draw(device(), method, count);
            ASSERT_EQ(ahead.colors.size(), alone.colors.size());
            for (size_t i = 0; i < alone.colors.size(); ++i) {
                EXPECT_TRUE(test::sameBits(ahead.colors[i], alone.colors[i]))
                    << method << count << ", " << i;
                EXPECT_EQ(ahead.counters[i], alone.counters[i]) << method << count << ", " << i;
            }
        }
    }
}

} // namespace
} // namespace shutter
