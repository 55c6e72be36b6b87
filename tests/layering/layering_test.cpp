// SPDX-License-Identifier: MIT
// The tree as it is, against the table of dependence and two rules of its text.
#include "tests/layering/include_reader.h"
#include "tests/layering/layer_table.h"
#include "tests/layering/standard_headers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace shutter::layering;

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = SHUTTER_SOURCE_DIR;

bool isFileOfTree(const std::string& path) {
    return fs::is_regular_file(kRoot / path);
}

std::vector<std::string> subfolders(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_directory())
            names.push_back(entry.path().filename().string());
    return names;
}

/// One failure a violation, and one if the folder holds no include at all.
void expectNoViolationBelow(std::string_view folder) {
    const std::vector<Include> includes = collectIncludes(kRoot, folder);
    EXPECT_FALSE(includes.empty()) << folder << " holds no include; was it moved?";
    for (const Include& include : includes)
        if (const auto violation = findViolation(include, isFileOfTree))
            ADD_FAILURE() << *violation;
}

} // namespace

TEST(Layering, EveryPartKeepsTheOrderOfDependence) {
    for (const char* folder : {"engine", "modules", "game", "assets/generator", "shaders"})
        expectNoViolationBelow(folder);
}

TEST(Layering, TheTableRefusesWhatStandsHigherBesideOrBehindALibrarysOwner) {
    for (const auto& [file, include] :
         {std::pair{"engine/scene/world.h", "\"engine/graph/graph.h\""},
          {"engine/render/renderer.cpp", "\"modules/tonemap/tonemap.h\""},
          {"engine/gpu/device.h", "\"../scene/world.h\""},
          {"engine/render/renderer.cpp", "\"tests/kit/graph_rig.h\""},
          {"modules/tonemap/tonemap.cpp", "\"modules/motion_blur/motion_blur.h\""},
          {"modules/motion_blur/motion_blur.h", "\"engine/scene/world.h\""},
          {"game/shot/shot.cpp", "\"game/output/film.h\""},
          {"game/shot/shot.cpp", "\"engine/gltf/gltf_parts.h\""},
          {"game/cli/main.cpp", "<GLFW/glfw3.h>"},
          {"shaders/render/brdf.glsl", "\"tonemap/curve.glsl\""}}) {
        const auto includes = readIncludes(file, std::string("#include ") + include);
        ASSERT_EQ(includes.size(), 1u);
        EXPECT_TRUE(findViolation(includes[0], isFileOfTree)) << file << " includes " << include;
    }
}

TEST(Layering, EveryEngineFolderHasARowAndEveryRowAFolder) {
    std::vector<std::string> onDisk = subfolders(kRoot / "engine");
    std::vector<std::string> inTable(engineFolders().begin(), engineFolders().end());
    // The window and the loop have their place in the order before they have a folder.
    if (!fs::exists(kRoot / "engine/app"))
        std::erase(inTable, "app");
    std::sort(onDisk.begin(), onDisk.end());
    std::sort(inTable.begin(), inTable.end());
    EXPECT_EQ(onDisk, inTable);
}

TEST(Layering, EveryShaderFolderMirrorsItsOwner) {
    for (const std::string& name : subfolders(kRoot / "shaders"))
        EXPECT_TRUE(
            name == "common" || fs::is_directory(kRoot / "engine" / name) ||
            fs::is_directory(kRoot / "modules" / name)
        ) << "shaders/"
          << name;
}

TEST(Layering, TheTreeIncludesTheStandardHeadersThatItUses) {
    SourceTree tree;
    for (const char* folder : {"engine", "modules", "game", "assets", "shaders", "tests"}) {
        const size_t before = tree.size();
        addSources(tree, kRoot, folder);
        EXPECT_GT(tree.size(), before) << folder << " holds no source; was it moved?";
    }
    for (const std::string& missing : findMissingHeaders(tree))
        ADD_FAILURE() << missing;
    const std::string text = "int a = std::min(1, 2);";
    const SourceTree wrong = {{"engine/a.cpp", {{}, readStandardNames(text)}}};
    EXPECT_EQ(findMissingHeaders(wrong).size(), 1u) << "the check finds nothing";
}

/// A compiler may assume in Vulkan that no float is NaN or infinite, so that it may drop these:
/// only a test of the bits (shaders/common/numeric.glsl) holds.
TEST(Layering, NoShaderTestsForNanByAComparison) {
    // An operand: a name, members and indices. What all but infinity are below begins at 3.4e38.
    const std::array rules = {
        std::regex(R"((^|[^\w.\]])([A-Za-z_]\w*(?:\.\w+|\[\w+\])*)\s*[!=]=\s*\2(?![\w.\[(]))"),
        std::regex(R"((^|[^\w])is(nan|inf)\s*\()"),
        std::regex(R"(([<>]|[<>=!]=)\s*-?3\.4\d*e\+?38)", std::regex::icase)};
    const auto isFound = [&](const std::string& line) {
        return std::any_of(rules.begin(), rules.end(), [&](const std::regex& rule) {
            return std::regex_search(line, rule);
        });
    };
    for (const char* line : {"if (!(v.x == v.x))", "return isnan(x);", "abs(x) <= 3.402823e38f"})
        EXPECT_TRUE(isFound(line)) << line;
    size_t fileCount = 0;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "shaders")) {
        if (!entry.is_regular_file())
            continue;
        ++fileCount;
        std::ifstream stream(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        std::istringstream lines(blankComments(text));
        for (std::string line; std::getline(lines, line);)
            EXPECT_FALSE(isFound(line)) << entry.path() << ": " << line;
    }
    EXPECT_GT(fileCount, 50u) << "were the shaders moved?";
}
