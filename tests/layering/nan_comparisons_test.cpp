// SPDX-License-Identifier: MIT
#include "tests/layering/nan_comparisons.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

using namespace shutter::layering;

namespace {

using Strings = std::vector<std::string>;

Strings findIn(const std::string& text) {
    return findNanComparisons("a.glsl", text);
}

} // namespace

TEST(NanComparisons, AValueComparedWithItselfIsFound) {
    const Strings once{"a.glsl:1 compares a value with itself"};
    EXPECT_EQ(findIn("if (!(x == x)) return;"), once);
    EXPECT_EQ(findIn("bool bad = color.x!=color.x;"), once);
    EXPECT_EQ(findIn("return rows[i].w == rows[i].w && y;"), once);
}

TEST(NanComparisons, TheLanguagesOwnTestsAndThoseAgainstTheLargestFloatAreFound) {
    EXPECT_EQ(findIn("\nreturn isnan(x);"), Strings{"a.glsl:2 asks isnan or isinf"});
    EXPECT_EQ(findIn("any(isinf (v))"), Strings{"a.glsl:1 asks isnan or isinf"});
    const Strings once{"a.glsl:1 compares with the largest float"};
    EXPECT_EQ(findIn("return abs(x) <= 3.402823e38f;"), once);
    EXPECT_EQ(findIn("x > -3.4E+38"), once);
}

TEST(NanComparisons, OtherComparisonsAndCommentsAreNot) {
    EXPECT_EQ(
        findIn("a.x == b.x; x == x.y; x == x2; p.x == x; x == x(); y[0] == y[1];"), Strings{}
    );
    EXPECT_EQ(findIn("// x == x\n/* isnan(x) */ vec3 low = vec3(3.402823e38f);"), Strings{});
}

TEST(NanComparisons, NoShaderHasOne) {
    const std::filesystem::path root = SHUTTER_SOURCE_DIR;
    size_t fileCount = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "shaders")) {
        if (!entry.is_regular_file())
            continue;
        ++fileCount;
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        const std::string path = entry.path().lexically_relative(root).generic_string();
        for (const std::string& found : findNanComparisons(path, text))
            ADD_FAILURE() << found;
    }
    EXPECT_GT(fileCount, 50u) << "were the shaders moved?";
}
