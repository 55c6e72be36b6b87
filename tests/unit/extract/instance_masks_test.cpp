// SPDX-License-Identifier: MIT
// A ray without an entity's mask passes that entity and no other.
#include "engine/extract/instance_masks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

namespace shutter::extract {
namespace {

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
            row.eyeFromObject[i][i] = 1.0f;
        row.eyeFromObject[2][3] = static_cast<float>(-distance);
        row.instanceMask = moves ? 0x55u : 0u; // whatever an earlier frame left
        if (moves)
            frame.movingRows.push_back(static_cast<uint32_t>(frame.entities.size()));
        DrawItem draw;
        draw.entity = static_cast<uint32_t>(frame.entities.size());
        (moves ? frame.opaque.moving : frame.opaque.still).push_back(draw);
        frame.entities.push_back(row);
        frame.entityMeshes.push_back(0);
        frame.changes.ownRows = frame.entities.size();
    }

    std::vector<uint32_t> assign() {
        assignInstanceMasks(frame, layout);
        std::vector<uint32_t> masks;
        for (const shader::EntityRow& row : frame.entities)
            masks.push_back(row.instanceMask);
        return masks;
    }

    ExtractedFrame frame;
    SceneLayout layout;
};

TEST_F(InstanceMasksOfAFrame, AnEmptyFrameHasNone) {
    EXPECT_TRUE(assign().empty());
}

TEST_F(InstanceMasksOfAFrame, WhatMovesGetsOneOfItsOwnAndWhatStandsStillGetsNone) {
    for (int i = 0; i < 20; ++i)
        add(5.0, i % 2 == 0);
    const auto masks = assign();
    std::set<uint32_t> given;
    for (size_t i = 0; i < masks.size(); ++i) {
        EXPECT_EQ(masks[i] != 0, i % 2 == 0) << i;
        if (masks[i] != 0) {
            EXPECT_TRUE(given.insert(masks[i]).second) << i;
        }
        EXPECT_EQ(solidMaskOf(frame.entities[i]), masks[i] != 0 ? masks[i] : kSharedInstanceMask);
    }
}

TEST_F(InstanceMasksOfAFrame, BeforeAMovingCameraWhatStandsStillInTheWorldGetsOneToo) {
    add(5.0, false);
    add(5.0, true);
    frame.movingRows.clear(); // it moves in the picture only
    std::swap(frame.opaque.moving, frame.opaque.still);
    frame.stillMotions.resize(1);
    const auto masks = assign();
    EXPECT_EQ(masks[0], 0u);
    EXPECT_NE(masks[1], 0u);
}

TEST_F(InstanceMasksOfAFrame, OnlyAnotherMaskChangesARow) {
    add(5.0, false);
    add(5.0, true);
    frame.changes.all = false;
    (void)assign();
    EXPECT_EQ(frame.changes.rows, std::vector<uint32_t>{1});
    frame.changes.rows.clear();
    (void)assign();
    EXPECT_TRUE(frame.changes.rows.empty());
}

TEST_F(InstanceMasksOfAFrame, WithMoreMoversThanMasksTheApparentlyLargestGetThem) {
    for (int i = 0; i < 100; ++i)
        add(3.0 + (i * 37) % 100, true);
    add(0.0, true); // the camera's own place: no division by zero
    const auto masks = assign();
    std::set<uint32_t> given;
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(masks[size_t(i)] != 0, (i * 37) % 100 < 33) << i;
        if (masks[size_t(i)] != 0) {
            EXPECT_TRUE(given.insert(masks[size_t(i)]).second) << i;
        }
    }
    EXPECT_NE(masks[100], 0u);
}

} // namespace
} // namespace shutter::extract
