// SPDX-License-Identifier: MIT
#include "engine/ecs/sparse_set.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace shutter::ecs {
namespace {

std::vector<uint32_t> listIndices(const SparseSetBase& set) {
    std::vector<uint32_t> indices;
    for (const Entity entity : set.entities())
        indices.push_back(entity.index);
    return indices;
}

TEST(SparseSet, AnEmptySetContainsNothing) {
    SparseSet<int> set;
    EXPECT_EQ(set.size(), 0u);
    EXPECT_FALSE(set.contains({0, 0}));
    EXPECT_FALSE(set.contains(kNullEntity));
    EXPECT_EQ(set.find({5, 0}), nullptr);
    EXPECT_FALSE(set.erase({5, 0}));
}

TEST(SparseSet, AValueIsFoundUnderItsEntityOnly) {
    SparseSet<std::string> set;
    set.insert({7, 2}, "seven");
    ASSERT_NE(set.find({7, 2}), nullptr);
    EXPECT_EQ(*set.find({7, 2}), "seven");
    EXPECT_EQ(set.find({7, 1}), nullptr);
    EXPECT_EQ(set.find({6, 2}), nullptr);
    EXPECT_FALSE(set.erase({7, 1}));
    EXPECT_EQ(set.size(), 1u);
}

TEST(SparseSet, InsertingAgainReplacesTheValueInPlace) {
    SparseSet<int> set;
    set.insert({1, 0}, 10);
    set.insert({2, 0}, 20);
    EXPECT_EQ(set.insert({1, 0}, 11), 11);
    EXPECT_EQ(set.size(), 2u);
    EXPECT_EQ(*set.find({1, 0}), 11);
    EXPECT_EQ(listIndices(set), (std::vector<uint32_t>{1, 2}));
}

TEST(SparseSet, ErasingMovesTheLastIntoTheGap) {
    SparseSet<std::string> set;
    for (uint32_t i = 0; i < 4; ++i)
        set.insert({i, 0}, std::to_string(i));
    EXPECT_TRUE(set.erase({1, 0}));
    EXPECT_EQ(listIndices(set), (std::vector<uint32_t>{0, 3, 2}));
    EXPECT_EQ(*set.find({0, 0}), "0");
    EXPECT_EQ(set.find({1, 0}), nullptr);
    EXPECT_EQ(*set.find({2, 0}), "2");
    EXPECT_EQ(*set.find({3, 0}), "3");
}

TEST(SparseSet, ErasingTheLastAndTheOnlyOneWorks) {
    SparseSet<std::string> set;
    set.insert({0, 0}, "a long enough string that it owns memory of its own");
    set.insert({9, 0}, "another");
    EXPECT_TRUE(set.erase({9, 0}));
    EXPECT_EQ(*set.find({0, 0}), "a long enough string that it owns memory of its own");
    EXPECT_TRUE(set.erase({0, 0}));
    EXPECT_EQ(set.size(), 0u);
    EXPECT_FALSE(set.erase({0, 0}));
}

TEST(SparseSet, ErasingDestroysTheValue) {
    const auto shared = std::make_shared<int>(1);
    SparseSet<std::shared_ptr<int>> set;
    set.insert({0, 0}, shared);
    set.insert({1, 0}, shared);
    EXPECT_EQ(shared.use_count(), 3);
    set.erase({0, 0});
    EXPECT_EQ(shared.use_count(), 2);
}

} // namespace
} // namespace shutter::ecs
