// SPDX-License-Identifier: MIT
#include "engine/ecs/entity.h"

#include <gtest/gtest.h>

#include <unordered_set>

namespace shutter::ecs {
namespace {

TEST(Entity, ADefaultEntityIsTheNullEntity) {
    EXPECT_EQ(Entity{}, kNullEntity);
    EXPECT_NE((Entity{0, 0}), kNullEntity);
}

TEST(Entity, ComparisonLooksAtIndexAndGeneration) {
    EXPECT_EQ((Entity{3, 1}), (Entity{3, 1}));
    EXPECT_NE((Entity{3, 1}), (Entity{3, 2}));
    EXPECT_NE((Entity{3, 1}), (Entity{4, 1}));
    EXPECT_LT((Entity{3, 9}), (Entity{4, 0}));
    EXPECT_LT((Entity{3, 1}), (Entity{3, 2}));
}

TEST(Entity, HashedContainersTellGenerationsApart) {
    const std::unordered_set<Entity> set = {{1, 0}, {1, 1}, {0, 1}, {1, 0}};
    EXPECT_EQ(set.size(), 3u);
    EXPECT_TRUE(set.contains({1, 1}));
    EXPECT_NE(std::hash<Entity>{}({1, 0}), std::hash<Entity>{}({1, 1}));
    EXPECT_NE(std::hash<Entity>{}({1, 0}), std::hash<Entity>{}({0, 1}));
}

TEST(Entity, FormatNamesIndexAndGeneration) {
    EXPECT_EQ(fmt::format("{}", Entity{3, 1}), "entity 3 (generation 1)");
    EXPECT_EQ(fmt::format("{}", kNullEntity), "the null entity");
}

} // namespace
} // namespace shutter::ecs
