// SPDX-License-Identifier: MIT
#include "game/shot/methods.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace shutter::game {

TEST(Methods, EachIsFoundByItsName) {
    for (const MethodInfo& method : listMethods()) {
        const auto found = findMethod(method.name);
        ASSERT_TRUE(found.ok());
        EXPECT_EQ(found.value(), &method);
        EXPECT_GT(std::string(method.description).size(), 0u);
    }
}

TEST(Methods, NamesAreDistinct) {
    std::set<std::string> names;
    for (const MethodInfo& method : listMethods())
        names.insert(method.name);
    EXPECT_EQ(names.size(), listMethods().size());
}

TEST(Methods, ASampleUnitHasADefault) {
    for (const MethodInfo& method : listMethods())
        EXPECT_EQ(method.sampleUnit.has_value(), method.defaultSamples != 0) << method.name;
}

TEST(Methods, TheHybridNeedsRaysAndTheGatherDoesWithout) {
    EXPECT_EQ(findMethod("hybrid").value()->rays, RayNeed::Any);
    EXPECT_EQ(findMethod("truth").value()->rays, RayNeed::Query);
    EXPECT_EQ(findMethod("denoised").value()->rays, RayNeed::Query);
    EXPECT_EQ(findMethod("gather").value()->rays, RayNeed::None);
}

TEST(Methods, AnUnknownNameIsAnsweredWithTheKnownOnes) {
    const auto found = findMethod("nosuch");
    ASSERT_FALSE(found.ok());
    for (const char* part :
         {"--method", "nosuch", "sharp", "gather", "hybrid", "accumulate", "truth"})
        EXPECT_NE(found.error().message.find(part), std::string::npos) << part;
}

} // namespace shutter::game
