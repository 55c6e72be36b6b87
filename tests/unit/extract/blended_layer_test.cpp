// SPDX-License-Identifier: MIT
// Which blended surfaces leave the raster, and how they are drawn.
#include "engine/extract/blended_layer.h"
#include "engine/scene/motion.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <algorithm>
#include <limits>

namespace shutter::extract {
namespace {

class BlendedLayers : public Extraction {
  protected:
    BlendedLayers() {
        glass = addMesh(scene::AlphaMode::Blend, 1);
        layout.hasBlended = true;
    }

    void move(ecs::Entity entity, const math::dvec3& velocity) {
        world.registry.add(entity, scene::LinearVelocity{velocity});
    }

    /// Of the entities in the layer.
    std::vector<ecs::Entity> findLayer() {
        ExtractedFrame frame = extract();
        frame.layerRows = findLayerRows(world, layout, request, motion(), frame);
        return listLayer(frame);
    }

    BlendedLayer plan(const LayerLimits& limits) {
        ExtractedFrame frame = extract();
        frame.layerRows = findLayerRows(world, layout, request, motion(), frame);
        return planBlendedLayer(world, layout, request, motion(), frame, limits);
    }

    static LayerLimits limitsOf(uint32_t instants) {
        return {
            .instants = instants,
            .findsInstants = true,
            .surfaceBytes = std::numeric_limits<uint64_t>::max()};
    }

    uint32_t glass = 0;

  private:
    static std::vector<ecs::Entity> listLayer(const ExtractedFrame& frame) {
        std::vector<ecs::Entity> entities;
        for (const uint32_t row : frame.layerRows)
            entities.push_back(frame.entityHandles[row]);
        return entities;
    }
};

TEST_F(BlendedLayers, GlassThatMovesIsInTheLayerAndGlassApartFromItIsNot) {
    const ecs::Entity moving = addBox({-6, 0, -20}, glass);
    move(moving, {1, 0, 0});
    addBox({10, 0, -20}, glass);
    EXPECT_EQ(findLayer(), std::vector{moving});
}

TEST_F(BlendedLayers, GlassBesideAMoverStaysAndGlassThatOneMayPassDoesNot) {
    addBox({12, 0, -20}, glass);
    const ecs::Entity passed = addBox({-4, 0, -10}, glass);
    const ecs::Entity mover = addBox({-12, 0, -20});
    EXPECT_TRUE(findLayer().empty());
    move(mover, {8, 0, 0});
    EXPECT_EQ(findLayer(), std::vector{passed});
}

TEST_F(BlendedLayers, SurfacesInFrontOfALayersSurfaceAreInItToo) {
    const ecs::Entity moving = addBox({0, 0, -20}, glass);
    move(moving, {1, 0, 0});
    const ecs::Entity before = addBox({0.5, 0, -12}, glass);
    const ecs::Entity beforeThat = addBox({1.5, 0, -8}, glass);
    addBox({-9, 0, -12}, glass);
    EXPECT_EQ(findLayer(), (std::vector{moving, before, beforeThat}));
}

TEST_F(BlendedLayers, AMovingCameraAloneTakesNothingOutOfTheRaster) {
    addBox({0, 0, -20}, glass);
    addBox({0, 0, -30});
    move(camera, {1, 0, 0});
    EXPECT_TRUE(findLayer().empty());
    // What rides with the camera moves in the world.
    const ecs::Entity visor = addBox({3, 0, -10}, glass);
    move(visor, {1, 0, 0});
    const std::vector<ecs::Entity> layer = findLayer();
    EXPECT_NE(std::find(layer.begin(), layer.end(), visor), layer.end());
}

TEST_F(BlendedLayers, AWorldWithoutBlendedGeometriesIsNotSearched) {
    move(addBox({0, 0, -20}, glass), {1, 0, 0});
    layout.hasBlended = false;
    EXPECT_TRUE(findLayer().empty());
}

TEST_F(BlendedLayers, InstantsFollowTheLongestMotion) {
    const ecs::Entity moving = addBox({0, 0, -20}, glass);
    move(moving, {0.4, 0, 0});
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
    const ecs::Entity mover = addBox({0, 0, -20});
    move(mover, {3, 0, 0});
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
    LayerLimits limits = limitsOf(15);
    limits.findsInstants = false;
    EXPECT_FALSE(plan(limits).readsInstants);
    EXPECT_EQ(plan(limits).partCount, 1u);
}

TEST_F(BlendedLayers, FewerInstantsAreLookedUpWithLessMemory) {
    addBox({0, 0, -10}, glass);
    move(addBox({0, 0, -5}), {3, 0, 0});
    LayerLimits limits = limitsOf(15);
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
    const ecs::Entity far = addBox({0, 0, -20}, glass);
    const ecs::Entity near = addBox({0.5, 0, -10}, glass);
    for (const ecs::Entity entity : {far, near})
        move(entity, {2, 0, 0});
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

TEST_F(BlendedLayers, SurfacesOutsideThePictureAreNotDrawn) {
    move(addBox({200, 0, -10}, glass), {1, 0, 0});
    EXPECT_TRUE(findLayer().empty());
    // Surfaces that enter it within the exposure are.
    move(addBox({14, 0, -10}, glass), {-6, 0, 0});
    EXPECT_EQ(findLayer().size(), 1u);
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
} // namespace shutter::extract
