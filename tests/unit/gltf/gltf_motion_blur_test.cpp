// SPDX-License-Identifier: MIT
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <string>

namespace shutter::gltf {
namespace {

core::Result<LoadedScene> loadExtras(const std::string& extras) {
    return loadMembers(
        R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"it","extras":)" + extras + "}]"
    );
}

/// Component of the only node.
const scene::MotionBlur* findBlur(const LoadedScene& loaded) {
    for (auto [entity, blur] : loaded.world.registry.view<scene::MotionBlur>()) {
        (void)entity;
        return &blur;
    }
    return nullptr;
}

TEST(GltfMotionBlur, IsReadFromExtras) {
    const LoadedScene both =
        expectLoads(loadExtras(R"({"motionBlur":{"scale":0.5,"exclude":true}})"));
    ASSERT_TRUE(findBlur(both));
    EXPECT_EQ(findBlur(both)->scale, 0.5);
    EXPECT_TRUE(findBlur(both)->exclude);
    const LoadedScene whole = expectLoads(loadExtras(R"({"motionBlur":{"scale":2}})"));
    ASSERT_TRUE(findBlur(whole));
    EXPECT_EQ(findBlur(whole)->scale, 2.0);
    EXPECT_FALSE(findBlur(whole)->exclude);
    const LoadedScene kept = expectLoads(loadExtras(R"({"motionBlur":{"exclude":false}})"));
    ASSERT_TRUE(findBlur(kept));
    EXPECT_EQ(findBlur(kept)->scale, 1.0);
}

TEST(GltfMotionBlur, OtherExtrasSayNothing) {
    // tinygltf drops members that are null or empty.
    for (const char* extras :
         {"{}", "3", "[1]", R"("motionBlur")", R"({"other":{"scale":9}})", R"({"motionBlur":{}})"})
        EXPECT_FALSE(findBlur(expectLoads(loadExtras(extras)))) << extras;
}

TEST(GltfMotionBlur, AnUnknownMemberIsWarnedOf) {
    const LoadedScene scene = expectLoads(loadExtras(R"({"motionBlur":{"excluded":true}})"));
    EXPECT_FALSE(findBlur(scene)->exclude);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0], "nodes[0].extras.motionBlur has a member 'excluded': not used");
}

TEST(GltfMotionBlur, BadValuesAreRefusedByName) {
    expectRefused(loadExtras(R"({"motionBlur":1})"), "nodes[0].extras.motionBlur");
    for (const char* scale : {"-0.1", "2.5", "1e31", "\"1\""})
        expectRefused(
            loadExtras(R"({"motionBlur":{"scale":)" + std::string(scale) + "}}"),
            "nodes[0].extras.motionBlur.scale"
        );
    for (const char* exclude : {"1", "\"yes\""})
        expectRefused(
            loadExtras(R"({"motionBlur":{"exclude":)" + std::string(exclude) + "}}"),
            "nodes[0].extras.motionBlur.exclude"
        );
}

} // namespace
} // namespace shutter::gltf
