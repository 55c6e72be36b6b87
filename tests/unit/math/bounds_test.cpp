// SPDX-License-Identifier: MIT
#include "engine/math/bounds.h"

#include <gtest/gtest.h>

#include <numbers>

namespace shutter::math {
namespace {

TEST(Bounds, AreEmptyUntilAPointIsAdded) {
    Bounds bounds;
    EXPECT_TRUE(bounds.isEmpty());
    bounds.add(dvec3(1.0, 2.0, 3.0));
    EXPECT_FALSE(bounds.isEmpty());
    EXPECT_EQ(bounds.centre(), dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(bounds.size(), dvec3(0.0));
}

TEST(Bounds, GrowToHoldEveryPoint) {
    Bounds bounds;
    bounds.add(dvec3(1.0, -2.0, 3.0));
    bounds.add(dvec3(-1.0, 4.0, 3.5));
    bounds.add(dvec3(0.0, 0.0, 3.2));
    EXPECT_EQ(bounds.min, dvec3(-1.0, -2.0, 3.0));
    EXPECT_EQ(bounds.max, dvec3(1.0, 4.0, 3.5));
    EXPECT_EQ(bounds.centre(), dvec3(0.0, 1.0, 3.25));
    EXPECT_EQ(bounds.size(), dvec3(2.0, 6.0, 0.5));
}

TEST(Bounds, AddingEmptyBoundsChangesNothing) {
    Bounds bounds;
    bounds.add(Bounds{});
    EXPECT_TRUE(bounds.isEmpty());
    bounds.add(dvec3(1.0));
    bounds.add(Bounds{});
    EXPECT_EQ(bounds.min, dvec3(1.0));
    EXPECT_EQ(bounds.max, dvec3(1.0));
}

TEST(Bounds, AddingBoundsHoldsBoth) {
    Bounds left;
    left.add(dvec3(0.0));
    Bounds right;
    right.add(dvec3(2.0, 3.0, 4.0));
    right.add(dvec3(-1.0, 5.0, 4.0));
    left.add(right);
    EXPECT_EQ(left.min, dvec3(-1.0, 0.0, 0.0));
    EXPECT_EQ(left.max, dvec3(2.0, 5.0, 4.0));
}

TEST(TransformBounds, EmptyStaysEmpty) {
    EXPECT_TRUE(transformBounds(dmat4(2.0), Bounds{}).isEmpty());
}

TEST(TransformBounds, ATurnedBoxIsBoxedAgain) {
    Bounds box;
    box.add(dvec3(-1.0));
    box.add(dvec3(1.0));
    const double eighth = std::numbers::pi / 4.0;
    const dmat4 turn = glm::rotate(dmat4(1.0), eighth, dvec3(0.0, 0.0, 1.0));
    const Bounds turned =
        transformBounds(glm::translate(dmat4(1.0), dvec3(5.0, 0.0, 0.0)) * turn, box);
    EXPECT_NEAR(turned.min.x, 5.0 - std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(turned.max.x, 5.0 + std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(turned.max.y, std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(turned.min.z, -1.0, 1e-12);
}

TEST(TransformBounds, AMirrorKeepsMinBelowMax) {
    Bounds box;
    box.add(dvec3(1.0, 2.0, 3.0));
    box.add(dvec3(2.0, 3.0, 4.0));
    const Bounds mirrored = transformBounds(glm::scale(dmat4(1.0), dvec3(-1.0, 1.0, 0.0)), box);
    EXPECT_EQ(mirrored.min, dvec3(-2.0, 2.0, 0.0));
    EXPECT_EQ(mirrored.max, dvec3(-1.0, 3.0, 0.0));
}

} // namespace
} // namespace shutter::math
