// SPDX-License-Identifier: MIT
#include "game/bench/case_setup.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;

class CaseSetupTest : public testing::Test {
  protected:
    void SetUp() override {
        mFolder = fs::path(testing::TempDir()) / "shutter_case_setup";
        fs::remove_all(mFolder);
        fs::create_directories(mFolder);
        write("s.gltf", R"({"asset": {"version": "2.0"},
            "buffers": [{"uri": "a.bin", "byteLength": 1}]})");
        write("a.bin", "1");
    }

    void TearDown() override { fs::remove_all(mFolder); }

    void write(const fs::path& name, const std::string& text) const {
        fs::create_directories((mFolder / name).parent_path());
        std::ofstream(mFolder / name, std::ios::binary) << text;
    }

    [[nodiscard]] std::string hash() const {
        Case shot;
        shot.shot.scene = (mFolder / "s.gltf").string();
        const auto setup = setUpCase(shot, {}, mFolder);
        EXPECT_TRUE(setup.ok());
        return setup ? setup.value().hash : std::string();
    }

    fs::path mFolder;
};

} // namespace

TEST_F(CaseSetupTest, WhatTheSceneDoesNotNameIsNotPartOfIt) {
    const std::string before = hash();
    write("notes.txt", "beside the scene");
    write("below/deep/file.bin", "below the scene");
    fs::create_symlink("nowhere", mFolder / "broken");
    EXPECT_EQ(hash(), before);
}

TEST_F(CaseSetupTest, ABufferIsPartOfTheScene) {
    const std::string before = hash();
    write("a.bin", "2");
    EXPECT_NE(hash(), before);
}

} // namespace shutter::bench
