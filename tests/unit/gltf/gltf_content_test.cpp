// SPDX-License-Identifier: MIT
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace shutter::gltf {
namespace {

namespace fs = std::filesystem;

TEST(SceneHash, ChangesWithTheSceneItsBuffersAndItsPictures) {
    const TempFolder folder;
    const std::string scene = R"({"asset": {"version": "2.0"},
        "buffers": [{"uri": "a.bin", "byteLength": 1},
                    {"uri": "data:application/octet-stream;base64,AA==", "byteLength": 1}, 3],
        "images": [{"uri": "a%20b.png"}, {"uri": "missing.png"}, {"bufferView": 0}]})";
    std::set<std::string> seen;
    const auto hash = [&] {
        const auto computed = computeSceneHash(folder.path() / "s.gltf");
        EXPECT_TRUE(computed.ok());
        return computed.value();
    };
    folder.write("s.gltf", scene);
    folder.write("a.bin", "1");
    folder.write("a b.png", "2");
    seen.insert(hash());
    EXPECT_TRUE(seen.contains(hash())) << "the same files have the same hash";
    folder.write("a.bin", "2");
    seen.insert(hash());
    folder.write("a b.png", "1");
    seen.insert(hash());
    folder.write("missing.png", "");
    seen.insert(hash());
    folder.write("s.gltf", scene + " ");
    seen.insert(hash());
    EXPECT_EQ(seen.size(), 5u);
}

TEST(SceneHash, CountsFilesOutsideTheFolderWhereTheyAreRead) {
    const TempFolder folder;
    const fs::path scene = folder.write(
        "sub/s.gltf",
        R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "../a.bin", "byteLength": 1}]})"
    );
    folder.write("a.bin", "1");
    const auto inside = computeSceneHash(scene);
    const auto outside = computeSceneHash(scene, io::Reach::Anywhere);
    EXPECT_NE(inside.value(), outside.value());
    folder.write("a.bin", "2");
    EXPECT_EQ(computeSceneHash(scene).value(), inside.value());
    EXPECT_NE(computeSceneHash(scene, io::Reach::Anywhere).value(), outside.value());
}

TEST(SceneHash, WhatIsNoSceneIsNamed) {
    const TempFolder folder;
    folder.write("s.gltf", "nothing");
    for (const char* name : {"s.gltf", "missing.gltf"}) {
        const auto hash = computeSceneHash(folder.path() / name);
        ASSERT_FALSE(hash.ok());
        EXPECT_NE(hash.error().message.find(name), std::string::npos);
    }
}

} // namespace
} // namespace shutter::gltf
