// SPDX-License-Identifier: MIT
#include "game/options/program.h"

#include <gtest/gtest.h>

#include <string>

namespace shutter::game {

TEST(ErrorOutput, ControlCharactersBecomeSpaces) {
    EXPECT_EQ(toOneLine("a\nb\tc\r\x1b[31m\x7f"), "a b c  [31m ");
    EXPECT_EQ(toOneLine(std::string("a\0b", 3)), "a b");
}

TEST(ErrorOutput, OtherTextStaysAsItIs) {
    EXPECT_EQ(toOneLine(""), "");
    EXPECT_EQ(toOneLine("größe 5 µm"), "größe 5 µm");
}

} // namespace shutter::game
