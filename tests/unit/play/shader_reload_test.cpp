// SPDX-License-Identifier: MIT
#include "game/play/loop/shader_reload.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace shutter::game {
namespace {

TEST(ShaderReload, ShowsTheFirstErrorOfWhatACompilerPrinted) {
    EXPECT_EQ(
        findCompilerError("[1/2] GLSL a.comp\nERROR: a.comp:3: 'x' : undeclared\nERROR: 2 errors\n"
        ),
        "ERROR: a.comp:3: 'x' : undeclared"
    );
    EXPECT_EQ(findCompilerError("ninja: error: no target"), "ninja: error: no target");
    EXPECT_EQ(findCompilerError("killed\n"), "killed");
    EXPECT_EQ(findCompilerError(""), "");
}

TEST(ShaderReload, ChangesNothingWhereAFileIsNoSpirv) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(::testing::TempDir()) / "shader_reload";
    fs::remove_all(folder);
    fs::create_directories(folder);
    ShaderReload reload;
    ASSERT_FALSE(reload.open(folder).ok()); // it holds none
    std::ofstream(folder / "a.comp.spv") << "eight by";
    ASSERT_TRUE(reload.open(folder).ok());
    EXPECT_TRUE(reload.reload().value().empty());
    std::ofstream(folder / "a.comp.spv") << "no SPIRV";
    const auto changed = reload.reload();
    ASSERT_FALSE(changed.ok());
    EXPECT_EQ(changed.error().message, "a.comp: it is no SPIR-V");
    fs::remove_all(folder);
}

} // namespace
} // namespace shutter::game
