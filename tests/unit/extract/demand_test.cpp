// SPDX-License-Identifier: MIT
// Requirements of a frame: deformation, masks, blending, and revealed surfaces.
#include "engine/extract/demand.h"
#include "engine/extract/instance_masks.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <vector>

namespace shutter::extract {
namespace {

TEST(Demand, OnlyDrawnSurfacesRequestTheirPasses) {
    ExtractedFrame frame;
    frame.opaque.still.push_back({.alphaMode = scene::AlphaMode::Opaque});
    const SurfaceDemand plain = decideSurfaces(frame);
    EXPECT_FALSE(plain.deformation.run || plain.alphaMask.run || plain.blending.run);
    EXPECT_EQ(describe(plain.alphaMask), "skipped: no surface in the picture has an alpha mask");
    frame.opaque.still.assign(2, {.alphaMode = scene::AlphaMode::Mask});
    frame.blended.moving.push_back({.alphaMode = scene::AlphaMode::Blend});
    frame.deformed.resize(3);
    const SurfaceDemand all = decideSurfaces(frame);
    EXPECT_EQ(
        describe(all.deformation), "ran: 3 drawn entities with a skin, morph targets or waves"
    );
    EXPECT_EQ(describe(all.alphaMask), "ran: 2 draws in the picture with an alpha mask");
    EXPECT_EQ(describe(all.blending), "ran: 1 blended draw in the picture");
}

/// Boxes that fill [-1, 1]^3 in front of a camera at the origin with -Z forward.
class Backdrop : public Extraction {
  protected:
    void addMover(const math::dvec3& position) { Extraction::addMover(position, {0.5, 0.0, 0.0}); }

    core::Decision decide() { return decideReveal(extract(), layout); }
};

TEST_F(Backdrop, SurfacesBehindOrNextToAMoverMayBeRevealed) {
    struct Case {
        const char* name;
        std::vector<math::dvec3> movers;
        std::vector<math::dvec3> still;
        bool isRevealed;
    };

    const std::vector<Case> cases = {
        {"nothing but sky", {{0, 0, -10}}, {}, false},
        {"behind", {{0, 0, -10}}, {{0, 0, -20}}, true},
        {"in front of it, and next to it", {{0, 0, -10}}, {{0, 0, -4}, {12, 0, -20}}, false},
        // The mover's right side at 1/9 of the distance, the other's left one at 2/18.
        {"adjoins it", {{0, 0, -10}}, {{3.302, 0, -19}}, true},
        {"another mover", {{0, 0, -10}, {0.5, 0, -14}}, {}, true},
        {"boxes that reach into each other", {{0, 0, -10}}, {{0, 0, -9}}, true},
        {"across the near plane: fills the picture", {{0, 0, -0.5}}, {{14, 0, -20}}, true},
        {"nothing moves", {}, {{0, 0, -10}, {0, 0, -20}}, false}};
    for (const Case& each : cases) {
        SCOPED_TRACE(each.name);
        world = {};
        request.camera = addCamera({});
        for (const math::dvec3& position : each.movers)
            addMover(position);
        for (const math::dvec3& position : each.still)
            addBox(position);
        const core::Decision decision = decide();
        EXPECT_EQ(decision.run, each.isRevealed);
        EXPECT_EQ(decision.reason == "nothing but sky lies behind movers", !each.isRevealed);
    }
}

TEST_F(Backdrop, NonFiniteBoxesMayBeAnywhereAndBlendedSurfacesAlwaysCount) {
    addMover({0.0, 0.0, -10.0});
    addBox({12.0, 0.0, -20.0});
    ExtractedFrame frame = extract();
    ASSERT_FALSE(decideReveal(frame, layout).run);
    frame.entities[1].relWorldFromObject[2][3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(decideReveal(frame, layout).run);
    addBox({12.0, 0.0, -20.0}, addMesh(scene::AlphaMode::Blend, 1));
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, ACameraThatMovesMakesEverythingAMover) {
    addBox({0.0, 0.0, -10.0});
    world.registry.add(camera, scene::LinearVelocity{{0.5, 0.0, 0.0}});
    EXPECT_FALSE(decide().run);
    addBox({0.0, 0.0, -20.0});
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, ManyMoversAreNotTestedOneByOne) {
    // In a fan: none lies behind another.
    for (int i = 0; i < 65; ++i)
        addMover({-8.0 + 0.25 * i, i % 2 == 0 ? 3.0 : -3.0, -900.0 - 10.0 * i});
    EXPECT_TRUE(decide().run);
}

/// Whether a ray that leaves `passed` out meets an instance of `mask`.
bool isMet(uint32_t mask, uint32_t passed) {
    return (mask & shader::kSolidMask & ~passed) != 0;
}

TEST(InstanceMasks, ARayPassesTheInstanceOfItsMaskAndNoOther) {
    std::vector<uint32_t> masks(listInstanceMasks().begin(), listInstanceMasks().end());
    ASSERT_EQ(masks.size(), 34u);
    for (size_t i = 0; i < masks.size(); ++i) {
        EXPECT_EQ(masks[i] & ~shader::kSolidMask, 0u);
        for (size_t j = 0; j < masks.size(); ++j)
            EXPECT_EQ(isMet(masks[j], masks[i]), i != j) << i << ", " << j;
        EXPECT_TRUE(isMet(kSharedInstanceMask, masks[i]));
        EXPECT_TRUE(isMet(shader::kSolidMask, masks[i]));
        EXPECT_TRUE(isMet(masks[i], 0));
    }
}

/// Boxes of one mesh: row i at distance distances[i], moving or not.
class InstanceMasksOfAFrame : public ::testing::Test {
  protected:
    InstanceMasksOfAFrame() { layout.bounds = {{math::dvec3(-1.0), math::dvec3(1.0)}}; }

    void add(double distance, bool moves) {
        shader::EntityRow row{};
        row.motion = moves ? 0u : shader::kNoMotion;
        for (int i = 0; i < 3; ++i)
            row.relWorldFromObject[i][i] = 1.0f;
        row.relWorldFromObject[2][3] = static_cast<float>(-distance);
        const DrawItem draw{.entity = static_cast<uint32_t>(frame.entities.size())};
        if (moves)
            frame.movingRows.push_back(draw.entity);
        (moves ? frame.opaque.moving : frame.opaque.still).push_back(draw);
        frame.entities.push_back(row);
        frame.entityMeshes.push_back(0);
    }

    std::vector<uint32_t> assign() {
        assigned = assignInstanceMasks(frame, layout);
        std::vector<uint32_t> masks;
        for (uint32_t row = 0; row < frame.entities.size(); ++row)
            masks.push_back(maskOf(assigned, row));
        return masks;
    }

    ExtractedFrame frame;
    SceneLayout layout;
    std::vector<RowMask> assigned;
};

TEST_F(InstanceMasksOfAFrame, TheApparentlyLargestMoversGetUniqueMasksAndStaticEntitiesNone) {
    for (int i = 0; i < 100; ++i)
        add(3.0 + (i * 37) % 100, true);
    add(0.0, true); // the camera's own place: no division by zero
    add(1.0, false);
    const auto masks = assign();
    std::set<uint32_t> given;
    for (size_t row = 0; row < masks.size(); ++row) {
        const bool isLarge = row == 100 || (row < 100 && (row * 37) % 100 < 33);
        EXPECT_EQ(masks[row] != 0, isLarge) << row;
        EXPECT_TRUE(masks[row] == 0 || given.insert(masks[row]).second) << row;
        EXPECT_EQ(
            solidMaskOf(assigned, uint32_t(row)), masks[row] != 0 ? masks[row] : kSharedInstanceMask
        );
    }
}

TEST_F(InstanceMasksOfAFrame, StaticEntitiesGetMasksUnderAMovingCamera) {
    add(5.0, false);
    add(5.0, true);
    frame.movingRows.clear(); // it moves in the picture only
    std::swap(frame.opaque.moving, frame.opaque.still);
    frame.staticMotions.resize(1);
    const auto masks = assign();
    EXPECT_EQ(masks[0], 0u);
    EXPECT_NE(masks[1], 0u);
}

} // namespace
} // namespace shutter::extract
