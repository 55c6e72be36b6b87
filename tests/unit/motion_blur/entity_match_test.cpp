// SPDX-License-Identifier: MIT
#include "modules/motion_blur/c_interface/entity_match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace shutter::motion_blur {
namespace {

constexpr uint32_t kNew = UINT32_MAX;
using Entities = std::vector<ShutterBlurEntity>;
using Indices = std::vector<uint32_t>;

TEST(EntityMatch, EachEntityFindsTheNearestOfItsModelOnce) {
    const Entities before{{1, {0, 0, 0}}, {1, {2, 0, 0}}, {2, {0, 0, 0}}, {1, {0, 5, 0}}};
    // The middle one is nearer to the second; the first is left for the one beside it.
    const Entities now{{1, {1.2, 0, 0}}, {1, {0.4, 0, 0}}, {2, {0.1, 0, 0}}, {3, {0, 0, 0}}};
    EXPECT_EQ(matchEntities(before, now, 2.0), (Indices{1, 0, 2, kNew}));
    EXPECT_EQ(matchEntities(before, now, 0.5), (Indices{kNew, 0, 2, kNew})) << "beyond reach";
    EXPECT_EQ(matchEntities(before, Entities{{1, {0, 8, 0}}}, 2.0), (Indices{kNew})) << "in y";
    EXPECT_EQ(
        matchEntities(Entities{{1, {0, 0, 0}}}, Entities{{1, {0.2, 0, 0}}, {1, {0.1, 0, 0}}}, 2.0),
        (Indices{kNew, 0})
    ) << "a second one beside it";
    EXPECT_EQ(matchEntities({}, now, 2.0), (Indices(4, kNew)));
    EXPECT_TRUE(matchEntities(before, {}, 2.0).empty());
}

TEST(EntityMatch, EqualDistancesAreResolvedByOrderAndPlacesThatAreNotFiniteMatchNothing) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const Entities before{{1, {1, 0, 0}}, {1, {-1, 0, 0}}, {1, {nan, 0, 0}}, {1, {infinity, 0, 0}}};
    const Entities now{{1, {0, 0, 0}}, {1, {0, nan, 0}}, {1, {infinity, 0, 0}}};
    EXPECT_EQ(matchEntities(before, now, infinity), (Indices{0, kNew, kNew}));
}

TEST(EntityMatch, ACrowdThatMovesLessThanItsSpacingIsFoundWhateverTheOrder) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> off(-0.3, 0.3);
    Entities before;
    for (uint32_t i = 0; i < 400; ++i)
        before.push_back({i % 3, {double(i % 20), double(i / 20), 0}});
    Indices order(before.size());
    for (uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    Entities now;
    for (const uint32_t i : order) {
        now.push_back(before[i]);
        for (double& place : now.back().place)
            place += off(random);
    }
    EXPECT_EQ(matchEntities(before, now, 0.6), order);
}

TEST(EntityMatch, TheCInterfaceRefusesNullListsAndAReachBelowZero) {
    const ShutterBlurEntity one{1, {0, 0, 0}};
    uint32_t found = 5;
    EXPECT_EQ(shutterBlurMatchEntities(&one, 1, &one, 1, 0.0, &found), SHUTTER_BLUR_SUCCESS);
    EXPECT_EQ(found, 0u);
    EXPECT_EQ(shutterBlurMatchEntities(nullptr, 0, nullptr, 0, 1.0, nullptr), SHUTTER_BLUR_SUCCESS);
    for (const double reach : {-1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_EQ(
            shutterBlurMatchEntities(&one, 1, &one, 1, reach, &found), SHUTTER_BLUR_ERROR_REFUSED
        );
    EXPECT_EQ(
        shutterBlurMatchEntities(nullptr, 1, &one, 1, 1.0, &found), SHUTTER_BLUR_ERROR_REFUSED
    );
    EXPECT_EQ(shutterBlurMatchEntities(&one, 1, &one, 1, 1.0, nullptr), SHUTTER_BLUR_ERROR_REFUSED);
}

} // namespace
} // namespace shutter::motion_blur
