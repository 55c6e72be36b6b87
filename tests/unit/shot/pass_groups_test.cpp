// SPDX-License-Identifier: MIT
#include "game/shot/methods.h"

#include <gtest/gtest.h>

namespace shutter::game {

namespace {

using render::PassOwner;

PassGroup groupIn(const char* method, PassOwner owner) {
    return groupOf(*findMethod(method).value(), owner);
}

} // namespace

TEST(PassGroups, AnEffectAndItsRaysCountAsBlurAndTheSceneDoesNot) {
    for (const char* method : {"gather", "hybrid", "denoised"}) {
        EXPECT_EQ(groupIn(method, PassOwner::Scene), PassGroup::Scene) << method;
        EXPECT_EQ(groupIn(method, PassOwner::Rays), PassGroup::Blur) << method;
        EXPECT_EQ(groupIn(method, PassOwner::Effect), PassGroup::Blur) << method;
    }
}

TEST(PassGroups, SharpAddsNothing) {
    for (const PassOwner owner : {PassOwner::Scene, PassOwner::Rays, PassOwner::Effect})
        EXPECT_EQ(groupIn("sharp", owner), PassGroup::Scene);
}

TEST(PassGroups, AMethodThatDrawsTheSceneItselfAddsAllItDraws) {
    for (const char* method : {"accumulate", "truth"})
        EXPECT_EQ(groupIn(method, PassOwner::Scene), PassGroup::Blur) << method;
}

TEST(PassGroups, NoMethodPaysForTheDisplay) {
    for (const MethodInfo& method : listMethods())
        EXPECT_EQ(groupOf(method, PassOwner::Display), PassGroup::Display) << method.name;
}

TEST(PassGroups, SumsCountEachPassOnce) {
    render::FrameStatistics frame;
    frame.passes = {
        {{"deform meshes", 1.0}, PassOwner::Scene},
        {{"build TLAS", 2.0}, PassOwner::Rays},
        {{"G-buffer", 4.0}, PassOwner::Scene},
        {{"gather", 8.0}, PassOwner::Effect},
        {{"tone map", 16.0}, PassOwner::Display}};
    EXPECT_EQ(sumBlurMilliseconds(*findMethod("hybrid").value(), frame), 10.0);
    EXPECT_EQ(sumBlurMilliseconds(*findMethod("accumulate").value(), frame), 15.0);
    EXPECT_EQ(sumFrameMilliseconds(frame), 15.0);
}

} // namespace shutter::game
