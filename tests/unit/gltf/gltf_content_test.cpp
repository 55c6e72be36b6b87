// SPDX-License-Identifier: MIT
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace shutter::gltf {
namespace {

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
