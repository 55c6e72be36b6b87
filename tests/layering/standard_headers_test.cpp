// SPDX-License-Identifier: MIT
#include "tests/layering/standard_headers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

using namespace shutter::layering;

namespace {

using Strings = std::vector<std::string>;

/// A tree of files and their texts.
SourceTree makeTree(const std::vector<std::pair<std::string, std::string>>& files) {
    SourceTree tree;
    for (const auto& [path, text] : files)
        tree[path] = {readIncludes(path, text), readStandardNames(text)};
    return tree;
}

} // namespace

TEST(StandardNames, AreReadFromCodeAlone) {
    EXPECT_EQ(
        readStandardNames("// std::sort\nauto a = std::min({b, \"std::max \\\" std::max\"}); "
                          "/* std::map */ int std_vector; std::min(a); using std::clamp"),
        (Strings{"clamp", "min"})
    );
}

TEST(StandardNames, IntegerTypesCountWithAndWithoutTheNamespace) {
    EXPECT_EQ(
        readStandardNames("uint32_t a; std::int64_t b; my_uint8_t c;"),
        (Strings{"int64_t", "uint32_t"})
    );
}

TEST(StandardHeaders, ANameWithoutItsHeaderIsFound) {
    const SourceTree tree =
        makeTree({{"engine/a.cpp", "#include <vector>\nint a = std::min({1, 2});\n"}});
    EXPECT_EQ(findMissingHeaders(tree), Strings{"engine/a.cpp uses std::min without <algorithm>"});
}

TEST(StandardHeaders, AHeaderMayComeByAFileOfTheTreeBesideTheFileFromTheRootOrFromTheShaders) {
    const SourceTree tree = makeTree(
        {{"engine/a.cpp", "#include \"b.h\"\nint a = std::min(1, 2);\n"},
         {"engine/b.h", "#include \"engine/core/c.h\"\n"},
         {"engine/core/c.h", "#include \"common/d.h\"\n"},
         {"shaders/common/d.h", "#include <algorithm>\n#include \"d.h\"\n"}}
    );
    EXPECT_EQ(findMissingHeaders(tree), Strings{});
}

TEST(StandardHeaders, AHeaderOfAnotherLibraryBringsNone) {
    const SourceTree tree =
        makeTree({{"engine/a.h", "#include <glm/glm.hpp>\n#include \"gen/x.h\"\nuint8_t a;\n"}});
    EXPECT_EQ(findMissingHeaders(tree), Strings{"engine/a.h uses std::uint8_t without <cstdint>"});
}

TEST(StandardHeaders, AHeaderForCBringsTheIntegerTypes) {
    const SourceTree tree = makeTree({{"engine/a.h", "#include <stdint.h>\nuint8_t a;\n"}});
    EXPECT_EQ(findMissingHeaders(tree), Strings{});
}

TEST(StandardHeaders, TheTreeIncludesWhatItUses) {
    const std::filesystem::path root = SHUTTER_SOURCE_DIR;
    SourceTree tree;
    for (const char* folder : {"engine", "modules", "game", "assets", "shaders", "tests"}) {
        const size_t before = tree.size();
        addSources(tree, root, folder);
        EXPECT_GT(tree.size(), before) << folder << " holds no source; was it moved?";
    }
    EXPECT_TRUE(std::any_of(tree.begin(), tree.end(), [](const auto& file) {
        return !file.second.standardNames.empty();
    }));
    for (const std::string& missing : findMissingHeaders(tree))
        ADD_FAILURE() << missing;
}
