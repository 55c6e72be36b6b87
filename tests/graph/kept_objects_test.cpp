// SPDX-License-Identifier: MIT
#include "engine/graph/kept_objects.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace shutter::graph {
namespace {

using Kept = KeptObjects<int, std::string>;

/// Each object costs its key.
uint64_t costOf(int key) {
    return static_cast<uint64_t>(key);
}

std::string* obtain(Kept& kept, int key, int& made) {
    if (std::string* object = kept.use(key))
        return object;
    return kept.add(key, "made " + std::to_string(++made));
}

TEST(KeptObjects, WhatComesBackIsNotMadeAnew) {
    Kept kept;
    int made = 0;
    for (int round = 0; round < 10; ++round) {
        kept.beginRound();
        EXPECT_EQ(*obtain(kept, round % 2, made), "made " + std::to_string(round % 2 + 1));
        kept.dropIdle(10, costOf);
    }
    EXPECT_EQ(made, 2);
}

TEST(KeptObjects, ARoundUsesEachObjectOnce) {
    Kept kept;
    int made = 0;
    for (int round = 0; round < 3; ++round) {
        kept.beginRound();
        EXPECT_NE(obtain(kept, 5, made), obtain(kept, 5, made));
    }
    EXPECT_EQ(made, 2);
}

TEST(KeptObjects, ThoseUnusedForLongestAreDroppedAndThoseInUseNever) {
    Kept kept;
    int made = 0;
    for (const int key : {1, 2, 3}) {
        kept.beginRound();
        (void)obtain(kept, key, made);
    }
    kept.beginRound();
    std::string* used = obtain(kept, 1, made);
    kept.dropIdle(3, costOf); // 2 and 3 are idle, 2 for longer
    EXPECT_EQ(kept.sum(costOf), 4u);
    kept.dropIdle(0, costOf);
    EXPECT_EQ(kept.sum(costOf), 1u);
    EXPECT_EQ(*used, "made 1") << "addresses stay";
}

TEST(KeptObjects, WhatNobodyUsedForSomeRoundsIsDropped) {
    Kept kept;
    int made = 0;
    kept.beginRound();
    (void)obtain(kept, 4, made);
    for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(kept.sum(costOf), 4u);
        kept.beginRound();
        kept.dropUnused(2);
    }
    EXPECT_EQ(kept.sum(costOf), 0u);
}

TEST(KeptObjects, NothingIsLeftAfterClearing) {
    Kept kept;
    int made = 0;
    (void)obtain(kept, 4, made);
    kept.clear();
    EXPECT_EQ(kept.sum(costOf), 0u);
    kept.dropIdle(0, costOf);
}

} // namespace
} // namespace shutter::graph
