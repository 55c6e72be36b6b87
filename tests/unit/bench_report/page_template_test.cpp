// SPDX-License-Identifier: MIT
#include "game/bench/report/page_template.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace shutter::bench {

TEST(FillPage, PutsEachValueInEachOfItsPlaces) {
    const auto filled = fillPage("<{{a}}>{{b}}{{a}}", {{"a", "one"}, {"b", ""}});
    ASSERT_TRUE(filled.ok());
    EXPECT_EQ(filled.value(), "<one>one");
}

TEST(FillPage, DoesNotSearchWhatItPutIn) {
    const auto filled = fillPage("{{a}} {{b}}", {{"a", "{{b}} }} {{"}, {"b", "two"}});
    ASSERT_TRUE(filled.ok());
    EXPECT_EQ(filled.value(), "{{b}} }} {{ two");
}

TEST(FillPage, LeavesSingleBraces) {
    const auto filled = fillPage("a { b } {{c}}", {{"c", "d"}});
    ASSERT_TRUE(filled.ok());
    EXPECT_EQ(filled.value(), "a { b } d");
}

TEST(FillPage, RefusesAPlaceWithoutAValueAndAValueWithoutAPlace) {
    const auto unknown = fillPage("{{a}}{{missing}}", {{"a", "x"}});
    ASSERT_FALSE(unknown.ok());
    EXPECT_NE(unknown.error().message.find("'missing'"), std::string::npos);
    const auto unused = fillPage("{{a}}", {{"a", "x"}, {"extra", "y"}});
    ASSERT_FALSE(unused.ok());
    EXPECT_NE(unused.error().message.find("'extra'"), std::string::npos);
}

TEST(FillPage, RefusesAPlaceThatDoesNotEnd) {
    EXPECT_FALSE(fillPage("{{a}} {{a", {{"a", "x"}}).ok());
}

TEST(EscapeForScript, LeavesNothingThatEndsTheElementOrTheLine) {
    const nlohmann::json value = {
        {"a", "</script><!-- </SCRIPT \xE2\x80\xA8 and \xE2\x80\xA9 <b>"},
        {"</key>", "\xE2\x80\x9C quoted \xE2\x80\x9D \xE2\x80"}}; // cut short: not UTF-8
    const std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const std::string escaped = escapeForScript(text);
    EXPECT_EQ(escaped.find('<'), std::string::npos);
    EXPECT_EQ(escaped.find("\xE2\x80\xA8"), std::string::npos);
    EXPECT_EQ(escaped.find("\xE2\x80\xA9"), std::string::npos);
    EXPECT_NE(escaped.find("\xE2\x80\x9C"), std::string::npos) << "other characters stay";
    EXPECT_EQ(nlohmann::json::parse(escaped), nlohmann::json::parse(text));
}

TEST(EscapeForScript, EndsWithItsText) {
    EXPECT_EQ(escapeForScript(""), "");
    EXPECT_EQ(escapeForScript("\xE2\x80"), "\xE2\x80");
    EXPECT_EQ(escapeForScript("\xE2\x80\xA8"), "\\u2028");
    EXPECT_EQ(escapeForScript("\xE2\x80\xA9"), "\\u2029");
}

} // namespace shutter::bench
