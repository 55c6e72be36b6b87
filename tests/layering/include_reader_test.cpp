// SPDX-License-Identifier: MIT
#include "tests/layering/include_reader.h"

#include <gtest/gtest.h>

using namespace shutter::layering;

TEST(IncludeReader, FindsBothKindsWithTheirLines) {
    const auto found = readIncludes(
        "engine/a.h", "#pragma once\n#include \"engine/b.h\"\n\n  #  include <vector> // why\n"
    );
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].file, "engine/a.h");
    EXPECT_EQ(found[0].line, 2u);
    EXPECT_EQ(found[0].target, "engine/b.h");
    EXPECT_TRUE(found[0].quoted);
    EXPECT_EQ(found[1].line, 4u);
    EXPECT_EQ(found[1].target, "vector");
    EXPECT_FALSE(found[1].quoted);
}

TEST(IncludeReader, FindsTheLastLineWithoutALineEndAndNothingInAnEmptyFile) {
    EXPECT_EQ(readIncludes("a.h", "#include <map>").size(), 1u);
    EXPECT_TRUE(readIncludes("a.h", "").empty());
}

TEST(IncludeReader, ReadsLinesThatEndAsOnWindows) {
    const auto found = readIncludes("a.h", "#include \"b.h\"\r\n#include <c>\r\n");
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].target, "b.h");
    EXPECT_EQ(found[1].target, "c");
}

TEST(IncludeReader, CommentsHideIncludesAndCodeAfterThemCounts) {
    const auto found = readIncludes(
        "a.h",
        "// #include \"x.h\"\n/* #include \"y.h\"\n#include \"z.h\"\n*/ #include \"w.h\"\n"
        "const char* url = \"http://\"; \n#include \"v.h\"\n"
    );
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].target, "w.h");
    EXPECT_EQ(found[0].line, 4u);
    EXPECT_EQ(found[1].target, "v.h");
}

TEST(IncludeReader, ConditionsDoNotHideAnInclude) {
    const auto found = readIncludes("a.h", "#if 0\n#include \"hidden.h\"\n#endif\n");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].target, "hidden.h");
}

TEST(IncludeReader, AMacroInPlaceOfAFileHasNoTarget) {
    const auto found = readIncludes("a.h", "#include SOME_HEADER\n");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(found[0].target.empty());
}
