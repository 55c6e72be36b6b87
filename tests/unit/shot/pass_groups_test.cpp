// SPDX-License-Identifier: MIT
#include "engine/render/post_effect.h"
#include "game/shot/methods.h"

#include <gtest/gtest.h>

namespace shutter::game {

namespace {

using render::PassOwner;

PassGroup groupIn(const char* method, PassOwner owner) {
    return groupOf(*findMethod(method).value(), owner);
}

/// An effect with the minimal interface.
class PlainEffect : public render::PostEffect {
    [[nodiscard]] std::string name() const override { return "plain"; }

    [[nodiscard]] core::Decision decide(const render::ViewFacts&) const override { return {}; }

    void declare(render::PostContext&) override {}
};

} // namespace

TEST(PassGroups, TheBlurAndItsRaysCountAsBlurAndTheSceneDoesNot) {
    for (const char* method : {"hybrid", "denoised"}) {
        EXPECT_EQ(groupIn(method, PassOwner::Scene), PassGroup::Scene) << method;
        EXPECT_EQ(groupIn(method, PassOwner::Rays), PassGroup::Blur) << method;
        EXPECT_EQ(groupIn(method, PassOwner::Blur), PassGroup::Blur) << method;
    }
}

TEST(PassGroups, SharpAddsNothing) {
    for (const PassOwner owner : {PassOwner::Scene, PassOwner::Rays, PassOwner::Other})
        EXPECT_NE(groupIn("sharp", owner), PassGroup::Blur);
}

TEST(PassGroups, AFilterOfTheLensIsWhatASharpMethodAdds) {
    MethodInfo filtered = *findMethod("sharp").value();
    filtered.lensFilter = &depth_of_field::getFilter("near_far");
    EXPECT_EQ(groupOf(filtered, PassOwner::Blur), PassGroup::Blur);
    EXPECT_EQ(groupOf(filtered, PassOwner::Scene), PassGroup::Scene);
    EXPECT_EQ(groupIn("sharp", PassOwner::Blur), PassGroup::Scene);
}

TEST(PassGroups, NoMethodPaysForAnEffectThatClaimsNothing) {
    for (const MethodInfo& method : listMethods())
        EXPECT_EQ(groupOf(method, PlainEffect().owner()), PassGroup::Other) << method.name;
}

TEST(PassGroups, RaysAreAnothersWhereTheMethodTracesNone) {
    EXPECT_EQ(groupIn("gather", PassOwner::Rays), PassGroup::Other);
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
        {{"gather", 8.0}, PassOwner::Blur},
        {{"bloom", 32.0}, PassOwner::Other},
        {{"tone map", 16.0}, PassOwner::Display}};
    EXPECT_EQ(sumBlurMilliseconds(*findMethod("hybrid").value(), frame), 10.0);
    EXPECT_EQ(sumBlurMilliseconds(*findMethod("accumulate").value(), frame), 13.0);
    EXPECT_EQ(sumFrameMilliseconds(frame), 47.0);
}

} // namespace shutter::game
