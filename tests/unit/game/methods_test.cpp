// SPDX-License-Identifier: MIT
#include "game/methods.h"
#include "game/report.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace shutter::game {

TEST(Methods, EachIsFoundByItsName) {
    for (const MethodInfo& method : listMethods()) {
        const auto found = findMethod(method.name);
        ASSERT_TRUE(found.ok());
        EXPECT_EQ(found.value()->id, method.id);
        EXPECT_GT(std::string(method.description).size(), 0u);
    }
}

TEST(Methods, NamesAndIdsAreDistinct) {
    std::set<std::string> names;
    std::set<MethodId> ids;
    for (const MethodInfo& method : listMethods()) {
        names.insert(method.name);
        ids.insert(method.id);
    }
    EXPECT_EQ(names, (std::set<std::string>{"sharp", "gather", "hybrid", "accumulate"}));
    EXPECT_EQ(ids.size(), names.size());
}

TEST(Methods, OnlyTheHybridNeedsRays) {
    for (const MethodInfo& method : listMethods())
        EXPECT_EQ(method.needsRays, method.id == MethodId::Hybrid) << method.name;
}

TEST(Methods, AnUnknownNameIsAnsweredWithTheKnownOnes) {
    const auto found = findMethod("nosuch");
    ASSERT_FALSE(found.ok());
    for (const char* part : {"--method", "nosuch", "sharp", "gather", "hybrid", "accumulate"})
        EXPECT_NE(found.error().message.find(part), std::string::npos) << part;
}

TEST(Report, ControlCharactersBecomeSpaces) {
    EXPECT_EQ(toOneLine("a\nb\tc\r\x1b[31m\x7f"), "a b c  [31m ");
    EXPECT_EQ(toOneLine(std::string("a\0b", 3)), "a b");
}

TEST(Report, OtherTextStaysAsItIs) {
    EXPECT_EQ(toOneLine(""), "");
    EXPECT_EQ(toOneLine("größe 5 µm"), "größe 5 µm");
}

} // namespace shutter::game
