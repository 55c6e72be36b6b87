// SPDX-License-Identifier: MIT
#include "engine/rays/deformed_blas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace shutter::rays {
namespace {

constexpr uint32_t kTurns = kRefitsPerBuild + 1;

TEST(RefitTurns, EverySixteenthTurnIsABuild) {
    for (size_t index = 0; index < 40; ++index) {
        RefitTurns turns(index);
        std::vector<uint32_t> builds;
        for (uint32_t frame = 0; frame < 4 * kTurns; ++frame)
            if (turns.take() == gpu::BuildAction::Build)
                builds.push_back(frame);
        ASSERT_EQ(builds.size(), 4u) << index;
        EXPECT_LT(builds.front(), kTurns);
        for (size_t i = 1; i < builds.size(); ++i)
            EXPECT_EQ(builds[i] - builds[i - 1], kTurns);
    }
}

TEST(RefitTurns, ACrowdThatIsFirstSeenTogetherIsNotBuiltTogetherAgain) {
    constexpr size_t kCrowd = 100;
    std::vector<RefitTurns> crowd;
    for (size_t i = 0; i < kCrowd; ++i)
        crowd.emplace_back(i);
    for (uint32_t frame = 0; frame < 3 * kTurns; ++frame) {
        const auto builds = std::count_if(crowd.begin(), crowd.end(), [](RefitTurns& turns) {
            return turns.take() == gpu::BuildAction::Build;
        });
        EXPECT_GE(builds, long(kCrowd / kTurns)) << frame;
        EXPECT_LE(builds, long(kCrowd / kTurns + 1)) << frame;
    }
}

} // namespace
} // namespace shutter::rays
