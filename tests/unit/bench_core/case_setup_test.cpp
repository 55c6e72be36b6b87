// SPDX-License-Identifier: MIT
#include "game/bench/case_stage.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace shutter::bench {

namespace {

class CaseSetupTest : public testing::Test {
  protected:
    void SetUp() override {
        mFolder.write("s.gltf", R"({"asset": {"version": "2.0"},
            "buffers": [{"uri": "a.bin", "byteLength": 1}]})");
        mFolder.write("a.bin", "1");
    }

    [[nodiscard]] std::string hash() const {
        Case shot;
        shot.shot.scene = (mFolder.path() / "s.gltf").string();
        const auto setup = setUpCase(shot, {}, mFolder.path());
        EXPECT_TRUE(setup.ok());
        return setup ? setup.value().hash : std::string();
    }

    test::TempFolder mFolder;
};

} // namespace

TEST_F(CaseSetupTest, WhatTheSceneDoesNotNameIsNotPartOfIt) {
    const std::string before = hash();
    mFolder.write("notes.txt", "beside the scene");
    mFolder.write("below/deep/file.bin", "below the scene");
    std::filesystem::create_symlink("nowhere", mFolder.path() / "broken");
    EXPECT_EQ(hash(), before);
}

TEST_F(CaseSetupTest, ABufferIsPartOfTheScene) {
    const std::string before = hash();
    mFolder.write("a.bin", "2");
    EXPECT_NE(hash(), before);
}

} // namespace shutter::bench
