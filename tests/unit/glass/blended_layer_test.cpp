// SPDX-License-Identifier: MIT
// Which blended surfaces leave the raster, and how they are drawn.
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "modules/glass/blended_layer.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::glass {
namespace {

using math::dvec3;

class BlendedLayers : public extract::Extraction {
  protected:
    BlendedLayers() {
        glass = addMesh(scene::AlphaMode::Blend, 1);
        layout.hasBlended = true;
    }

    /// Of the entities in the layer.
    std::vector<ecs::Entity> findLayer() {
        extract::ExtractedFrame frame = extract();
        std::vector<ecs::Entity> entities;
        for (const uint32_t row : findLayerRows(world, layout, request, motion(), frame))
            entities.push_back(frame.entityHandles[row]);
        return entities;
    }

    BlendedLayer plan(const render::OverlayLimits& limits) {
        extract::ExtractedFrame frame = extract();
        const auto taken = findLayerRows(world, layout, request, motion(), frame);
        return planBlendedLayer(world, layout, request, motion(), frame, taken, limits);
    }

    static render::OverlayLimits limitsOf(uint32_t instants) {
        return {
            .instants = instants,
            .findsInstants = true,
            .surfaceBytes = std::numeric_limits<uint64_t>::max()};
    }

    uint32_t glass = 0;
};

TEST_F(BlendedLayers, GlassThatAMotionMayPassOrThatIsBeforeSuchGlassLeavesTheRaster) {
    struct Box {
        dvec3 position;
        dvec3 velocity{0.0};
        bool isGlass = true;
        bool isInLayer = false;
    };

    struct Case {
        const char* name;
        std::vector<Box> boxes;
        dvec3 cameraVelocity{0.0};
    };

    const std::vector<Case> cases{
        {"glass that moves, and glass apart from it",
         {{{-6, 0, -20}, {1, 0, 0}, true, true}, {{10, 0, -20}}}},
        {"glass beside a static box", {{{12, 0, -20}}, {{-4, 0, -10}}, {{-12, 0, -20}, {}, false}}},
        {"glass that a mover may pass",
         {{{12, 0, -20}}, {{-4, 0, -10}, {}, true, true}, {{-12, 0, -20}, {8, 0, 0}, false}}},
        {"surfaces in front of a layer's surface",
         {{{0, 0, -20}, {1, 0, 0}, true, true},
          {{0.5, 0, -12}, {}, true, true},
          {{1.5, 0, -8}, {}, true, true},
          {{-9, 0, -12}}}},
        {"surfaces outside the picture, and those that enter it within the exposure",
         {{{200, 0, -10}, {1, 0, 0}}, {{14, 0, -10}, {-6, 0, 0}, true, true}}},
        {"static surfaces that a moving camera sees move against what lies behind them",
         {{{0, 0, -20}, {}, true, true}, {{0, 0, -30}, {}, false}},
         {1, 0, 0}},
        {"a visor that rides with the camera moves in the world",
         {{{3, 0, -10}, {1, 0, 0}, true, true}},
         {1, 0, 0}}};
    for (const Case& each : cases) {
        SCOPED_TRACE(each.name);
        world = {};
        request.camera = camera = addCamera({});
        world.registry.add(camera, scene::LinearVelocity{each.cameraVelocity});
        std::vector<ecs::Entity> expected;
        for (const Box& box : each.boxes) {
            const auto entity = addMover(box.position, box.velocity, box.isGlass ? glass : 0);
            if (box.isInLayer)
                expected.push_back(entity);
        }
        EXPECT_EQ(findLayer(), expected);
        layout.hasBlended = false;
        EXPECT_TRUE(findLayer().empty()) << "a world without blended geometries is not searched";
        layout.hasBlended = true;
    }
}

TEST_F(BlendedLayers, StaticGlassThatMovesAsItsBackgroundInThePictureStaysInTheRaster) {
    const auto addQuad = [&](scene::AlphaMode alphaMode) {
        scene::Mesh& mesh = world.assets.meshes.emplace_back();
        scene::Primitive& quad = mesh.primitives.emplace_back();
        quad.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        quad.indices = {0, 1, 2, 0, 2, 3};
        return addMesh(alphaMode, 1);
    };

    struct Case {
        const char* name;
        double depth; ///< of the glass; the wall's is 10 m
        dvec3 cameraVelocity{0.0};
        dvec3 cameraTurn{0.0};
        bool hasLens = false;
        bool isInLayer = false;
        dvec3 wallPlace{0.0, 0.0, -10.0};
    };

    const Case cases[] = {
        {"a decal before a moving camera", 9.999, {2, 0, 0}},
        {"a decal that lies in the wall, within rounding", 10.0, {2, 0, 0}},
        {"a decal of a wall out of focus", 9.999, {}, {}, true},
        {"glass before a camera that turns", 5.0, {}, {0, 0.2, 0}},
        {"glass before a camera that rests, with a pinhole", 5.0},
        {"glass before a moving camera", 5.0, {2, 0, 0}, {}, false, true},
        {"glass before a camera that comes nearer", 5.0, {0, 0, -1}, {}, false, true},
        {"glass before a lens", 5.0, {}, {}, true, true},
        {"glass beside the wall", 9.999, {2, 0, 0}, {}, false, true, {4.0, 0.0, -10.0}}};
    for (const Case& each : cases) {
        SCOPED_TRACE(each.name);
        reset();
        layout = {};
        const uint32_t wall = addQuad(scene::AlphaMode::Opaque);
        const uint32_t pane = addQuad(scene::AlphaMode::Blend);
        layout.hasBlended = true;
        world.registry.add(camera, scene::LinearVelocity{each.cameraVelocity});
        world.registry.add(camera, scene::AngularVelocity{each.cameraTurn});
        world.registry.add(camera, scene::CameraLens{.fStop = 0.02, .focusDistance = 3.0});
        math::Transform large;
        large.translation = each.wallPlace;
        large.scale = dvec3(3.0);
        addBox(large, wall);
        addBox({0, 0, -each.depth}, pane);
        extract::ExtractedFrame frame = extract();
        const auto rows = findLayerRows(world, layout, request, motion(), frame, each.hasLens);
        EXPECT_EQ(!rows.empty(), each.isInLayer);
    }
}

TEST_F(BlendedLayers, InstantsOfALensHavePlacesOfItAndReachOverItsCircles) {
    world.registry.add(camera, scene::CameraLens{.fStop = 0.02, .focusDistance = 40.0});
    addBox({0, 0, -10}, glass);
    extract::ExtractedFrame frame = extract();
    render::OverlayLimits limits = limitsOf(15);
    limits.hasLens = true;
    const auto taken = findLayerRows(world, layout, request, motion(), frame, true);
    const BlendedLayer layer =
        planBlendedLayer(world, layout, request, motion(), frame, taken, limits);
    ASSERT_EQ(layer.instants.size(), 15u);
    double mean = 0.0;
    double widest = 0.0;
    for (const shader::LayerPlace& place : layer.places) {
        const math::vec4 clip = place.clipFromObject * math::vec4(0, 0, 0, 1);
        mean += double(clip.x / clip.w) / 15.0;
        widest = std::max(widest, std::abs(double(clip.x / clip.w)));
    }
    // Half the circle of confusion at 10 m, in half widths of the picture.
    const auto& lens = world.registry.get<scene::CameraLens>(camera);
    const double yFov = world.registry.get<scene::Camera>(camera).yFov;
    const double radius = scene::computeLensRadius(lens, yFov) * (1.0 / 10.0 - 1.0 / 40.0) /
                          (2.0 * std::tan(yFov / 2.0));
    EXPECT_NEAR(mean, 0.0, 0.15 * radius);
    EXPECT_LE(widest, 1.001 * radius);
    EXPECT_GE(widest, 0.8 * radius);
    EXPECT_GE(layer.longestWayPx, 2.0 * radius * 100.0);
}

TEST_F(BlendedLayers, InstantsFollowTheLongestMotion) {
    const ecs::Entity moving = addMover({0, 0, -20}, {0.4, 0, 0}, glass);
    const BlendedLayer slow = plan(limitsOf(15));
    EXPECT_FALSE(slow.readsInstants);
    EXPECT_EQ(slow.partCount, 1u);
    EXPECT_EQ(slow.instants.size(), size_t(std::ceil(slow.longestWayPx / kLayerStepPx)));
    EXPECT_LT(slow.instants.size(), 4u);
    world.registry.get<scene::LinearVelocity>(moving).metresPerSecond.x = 20.0;
    EXPECT_EQ(plan(limitsOf(15)).instants.size(), 15u);
    EXPECT_EQ(plan(limitsOf(4)).instants.size(), 4u);
    EXPECT_EQ(plan({.instants = 15, .leastInstants = 4}).instants.size(), 15u);
}

TEST_F(BlendedLayers, StaticGlassBeforeAMoverIsDrawnOnceAndBehindOneAtEachInstant) {
    addBox({0, 0, -10}, glass);
    const ecs::Entity mover = addMover({0, 0, -20}, {3, 0, 0});
    const BlendedLayer before = plan(limitsOf(15));
    EXPECT_FALSE(before.readsInstants);
    EXPECT_EQ(before.instants.size(), 1u);
    EXPECT_FLOAT_EQ(before.instants.front().time, 0.5f);
    world.registry.get<scene::LocalTransform>(mover).transform.translation.z = -5.0;
    const BlendedLayer behind = plan(limitsOf(15));
    EXPECT_TRUE(behind.readsInstants);
    EXPECT_EQ(behind.instants.size(), 15u);
    EXPECT_EQ(behind.partCount, shader::kMaxSurfaceParts);
    // A method without lookups has the raster's depth.
    render::OverlayLimits limits = limitsOf(15);
    limits.findsInstants = false;
    EXPECT_FALSE(plan(limits).readsInstants);
    EXPECT_EQ(plan(limits).partCount, 1u);
}

TEST_F(BlendedLayers, FewerInstantsAreLookedUpWithLessMemory) {
    addBox({0, 0, -10}, glass);
    addMover({0, 0, -5}, {3, 0, 0});
    render::OverlayLimits limits = limitsOf(15);
    const shader::InstantSurfaces whole = plan(limits).surfaces();
    const uint64_t pixels = shader::surfacePixels(whole);
    limits.surfaceBytes = sizeof(whole) + pixels * 4 * 11; // 6 depths in 3 words, 4 parts in 8
    const BlendedLayer fewer = plan(limits);
    EXPECT_TRUE(fewer.readsInstants);
    EXPECT_EQ(fewer.instants.size(), 6u);
    EXPECT_EQ(fewer.partCount, 4u);
    limits.surfaceBytes = pixels;
    const BlendedLayer none = plan(limits);
    EXPECT_FALSE(none.readsInstants);
    EXPECT_EQ(none.partCount, 1u);
}

TEST_F(BlendedLayers, TheNearestIsDrawnFirstAndPlacesAreOfTheItems) {
    addMover({0, 0, -20}, {2, 0, 0}, glass);
    addMover({0.5, 0, -10}, {2, 0, 0}, glass);
    const BlendedLayer layer = plan(limitsOf(15));
    ASSERT_EQ(layer.items.size(), 2u);
    EXPECT_LT(layer.items[0].draw.distance, layer.items[1].draw.distance);
    ASSERT_EQ(layer.places.size(), 2 * layer.instants.size());
    // The middle of the nearest at the first instant, in camera-relative space.
    const shader::LayerPlace& place = layer.places[layer.items[0].firstPlace];
    EXPECT_NEAR(
        place.relWorldFromObject[0].w, 0.5 + 2.0 * (layer.instants.front().time - 1.0) + 2.0, 0.01
    );
    EXPECT_NEAR(place.relWorldFromObject[2].w, -10.0, 1.0e-6);
    const math::vec4 clip = place.clipFromObject * math::vec4(0, 0, 0, 1);
    EXPECT_NEAR(clip.w, 10.0, 1.0e-5);
}

TEST(LayerInstants, InstantsAreSymmetricInTime) {
    for (uint32_t all = 1; all <= 40; ++all)
        for (uint32_t count = 1; count <= all; ++count)
            for (uint32_t i = 0; i < count; ++i) {
                const uint32_t taken = shader::takenInstant(i, count, all);
                EXPECT_LT(taken, all);
                if (i > 0) {
                    EXPECT_GT(taken, shader::takenInstant(i - 1, count, all));
                }
                const uint32_t fromEnd = count - 1 - i;
                if (i == fromEnd) // no instant of an even number is in the middle
                    continue;
                EXPECT_EQ(shader::takenInstant(fromEnd, count, all), all - 1 - taken)
                    << i << " of " << count << " of " << all;
            }
}

} // namespace
} // namespace shutter::glass
