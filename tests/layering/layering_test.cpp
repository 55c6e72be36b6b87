// SPDX-License-Identifier: MIT
// The tree as it is, against the table.
#include "tests/layering/include_reader.h"
#include "tests/layering/layer_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

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

TEST(Layering, TheEngineKeepsTheOrderOfDependence) {
    expectNoViolationBelow("engine");
}

TEST(Layering, TheModulesKeepTheOrderOfDependence) {
    expectNoViolationBelow("modules");
}

TEST(Layering, TheGameKeepsTheOrderOfDependence) {
    expectNoViolationBelow("game");
}

TEST(Layering, TheAssetGeneratorKeepsTheOrderOfDependence) {
    expectNoViolationBelow("assets/generator");
}

TEST(Layering, TheShadersKeepTheOrderOfDependence) {
    expectNoViolationBelow("shaders");
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
