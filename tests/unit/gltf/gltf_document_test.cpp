// SPDX-License-Identifier: MIT
// Files as a whole: containers, buffers, references, and the hash of their contents.
#include "tests/support/outcomes.h"
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace shutter::gltf {
namespace {

namespace fs = std::filesystem;

std::string u32(uint32_t value) {
    std::string bytes(4, '\0');
    for (size_t i = 0; i < 4; ++i)
        bytes[i] = char(value >> (8 * i) & 0xFF);
    return bytes;
}

std::string chunk(std::string_view type, std::string data, char padding) {
    data.resize((data.size() + 3) / 4 * 4, padding);
    return u32(uint32_t(data.size())) + std::string(type) + data;
}

std::string glb(const std::string& chunks, uint32_t version = 2) {
    return "glTF" + u32(version) + u32(uint32_t(12 + chunks.size())) + chunks;
}

constexpr std::string_view kBin("BIN\0", 4);

core::Result<LoadedScene> loadBytes(std::string_view content, const char* name = "test.glb") {
    const TempFolder folder;
    return loadGltf(folder.write(name, content));
}

std::string nested(size_t depth) {
    return R"({"asset":{"version":"2.0"},"extras":)" + std::string(depth, '[') +
           std::string(depth, ']') + "}";
}

TEST(GltfDocument, AMissingFileAFolderAndAnEmptyFileAreOneSentenceEach) {
    const TempFolder folder;
    expectRefused(loadGltf(folder.path() / "none.gltf"), "no such file");
    expectRefused(loadGltf(folder.path()), "is a folder");
    expectRefused(loadGltf(folder.write("empty.gltf", "")), "is empty");
    expectRefused(loadGltf(folder.write("text.gltf", "hello")), "neither glTF JSON nor a GLB");
    expectRefused(loadGltf(""), "no such file");
}

TEST(GltfDocument, AnEmptySceneAByteOrderMarkAndWholeNumbersWithAPointAreAccepted) {
    const LoadedScene scene = readMembers("");
    EXPECT_EQ(scene.world.registry.aliveCount(), 0u);
    EXPECT_TRUE(scene.warnings.empty());
    expectLoads(loadBytes("\xEF\xBB\xBF{\"asset\":{\"version\":\"2.0\"}}", "test.gltf"));
    const LoadedScene pointed =
        readMembers(R"("scene":0.0,"scenes":[{"nodes":[1.0]}],"nodes":[{},{}])");
    EXPECT_EQ(pointed.world.registry.aliveCount(), 1u);
}

TEST(GltfDocument, VersionsAreChecked) {
    const auto load = [](const std::string& asset) {
        return loadBytes(R"({"asset":)" + asset + "}", "test.gltf");
    };
    expectLoads(load(R"({"version":"2.0"})"));
    expectLoads(load(R"({"version":"2.9"})"));
    expectLoads(load(R"({"version":"2.9","minVersion":"2.0"},"nodes":[{}])"));
    const char* newer = R"({"version":"2.1","minVersion":"2.1"},"nodes":[{}])";
    expectRefused(load(newer), "minVersion");
    expectRefused(load(R"({"version":"1.0"})"), "asset.version");
    expectRefused(load(R"({"version":"2"})"), "asset.version");
    expectRefused(load(R"({"version":2.0})"), "asset.version");
    expectRefused(load(R"({"version":"2.0x"})"), "asset.version");
    expectRefused(load("{}"), "asset.version");
    expectRefused(load("3"), "asset");
}

TEST(GltfDocument, BrokenAndDeeplyNestedJsonIsRefusedAndOrdinaryNestingIsNot) {
    expectLoads(loadBytes(nested(200), "test.gltf"));
    expectRefused(loadBytes(nested(1000), "test.gltf"), "nests deeper");
    expectRefused(loadBytes(std::string(1000000, '['), "test.gltf"), "nests deeper");
    const std::string brackets(1000, '[');
    expectLoads(
        loadBytes(R"({"asset":{"version":"2.0"},"extras":"\"[)" + brackets + "\"}", "test.gltf")
    );
    expectRefused(loadBytes(R"({"asset":)", "test.gltf"), "does not parse");
    expectRefused(loadBytes("[1]", "test.gltf"), "root is not an object");
    expectRefused(loadBytes("{\"asset\":{\"version\":\"\xFF\"}}", "test.gltf"), "does not parse");
}

TEST(GltfDocument, RequiredExtensionsAreNamedWhenTheyAreNotSupported) {
    expectRefused(loadMembers(R"("extensionsRequired":["EXT_foo"])"), "EXT_foo");
    readMembers(R"("extensionsRequired":["KHR_materials_unlit","KHR_texture_transform",
            "EXT_lights_image_based",
            "KHR_lights_punctual","KHR_materials_emissive_strength","KHR_physics_rigid_bodies",
            "KHR_mesh_quantization"])");
    EXPECT_TRUE(hasWarning(readMembers(R"("extensionsUsed":["EXT_foo"])"), "EXT_foo"));
}

TEST(GltfDocument, AGlbLoadsUnderAnyNameAndReadsItsBinaryChunk) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    const std::string json = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})";
    const std::string bin(file.bin());
    const std::string jsonChunk = chunk("JSON", json, ' ');
    const LoadedScene scene = expectLoads(loadBytes(glb(jsonChunk + chunk(kBin, bin, '\0'))));
    ASSERT_EQ(scene.world.assets.meshes.size(), 1u);
    ASSERT_EQ(scene.world.assets.meshes[0].primitives.size(), 1u);
    EXPECT_EQ(scene.world.assets.meshes[0].primitives[0].positions[1].x, 1.0f);
    // A chunk of an unknown type is skipped.
    expectLoads(loadBytes(glb(jsonChunk + chunk(kBin, bin, '\0') + chunk("ABCD", "x", ' '))));
    expectRefused(loadBytes(glb(jsonChunk)), "buffers[0]");
    expectRefused(loadBytes(glb(jsonChunk + chunk(kBin, bin.substr(0, 32), '\0'))), "byteLength");
    const GltfFile empty;
    const std::string content = glb(chunk("JSON", empty.json(""), ' '));
    expectLoads(loadBytes(content));
    expectLoads(loadBytes(content, "test.gltf"));
    expectLoads(loadBytes(content + "trailing"));
    expectLoads(loadBytes(empty.json(""), "json.glb"));
}

TEST(GltfDocument, DamagedGlbContainersAreRefused) {
    const std::string json = chunk("JSON", GltfFile().json(""), ' ');
    expectRefused(loadBytes("glTF"), "header is cut off");
    expectRefused(loadBytes(glb(json, 1)), "version 1");
    expectRefused(loadBytes(glb("")), "no JSON chunk");
    expectRefused(loadBytes(glb(json).substr(0, 40)), "header states");
    expectRefused(loadBytes(glb(chunk(kBin, "abcd", '\0'))), "first chunk is not JSON");
    expectRefused(loadBytes(glb(json + json)), "two JSON chunks");
    expectRefused(
        loadBytes(glb(json + chunk(kBin, "abcd", '\0') + chunk(kBin, "abcd", '\0'))), "two BIN"
    );
    expectRefused(loadBytes(glb(json + u32(0xFFFFFFFFu) + "BIN")), "cut off");
    expectRefused(loadBytes(glb(u32(0xFFFFFFFFu) + "JSON{}")), "longer than the file");
}

TEST(GltfDocument, BuffersComeFromFilesAndDataUris) {
    const TempFolder folder;
    folder.write("sub dir/b.bin", "0123456789");
    const auto load = [&](const std::string& buffer) {
        return loadGltf(
            folder.write("test.gltf", R"({"asset":{"version":"2.0"},"buffers":[)" + buffer + "]}")
        );
    };
    expectLoads(load(R"({"byteLength":10,"uri":"sub%20dir/b.bin"})"));
    expectLoads(load(R"({"byteLength":4,"uri":"sub dir/b.bin"})"));
    expectLoads(load(R"({"byteLength":3,"uri":"data:;base64,Zm9v"})"));
    expectRefused(load(R"({"byteLength":11,"uri":"sub dir/b.bin"})"), "byteLength is 11");
    expectRefused(load(R"({"byteLength":4,"uri":"data:;base64,Zm9v"})"), "byteLength is 4");
    expectRefused(load(R"({"byteLength":1,"uri":"none.bin"})"), "none.bin");
    expectRefused(load(R"({"byteLength":1,"uri":"sub dir"})"), "folder");
    expectRefused(load(R"({"byteLength":1,"uri":"/etc/hostname"})"), "leaves");
    expectRefused(load(R"({"byteLength":1})"), "no uri");
    expectRefused(load(R"({"uri":"sub dir/b.bin"})"), "buffers[0].byteLength is missing");
}

TEST(GltfDocument, FilesOutsideTheFolderAreReadWhereTheCallerAllowsIt) {
    const TempFolder folder;
    folder.write("b.bin", "0123");
    for (const std::string& uri : {std::string("../b.bin"), (folder.path() / "b.bin").string()}) {
        const fs::path file = folder.write(
            "sub/test.gltf",
            R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":")" + uri + R"("}]})"
        );
        expectRefused(loadGltf(file), "leaves the file's folder");
        expectLoads(loadGltf(file, {.reach = io::Reach::Anywhere}));
    }
}

TEST(GltfDocument, DecodedBytesAboveTheCallersLimitAreRefused) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    const TempFolder folder;
    folder.write("data.bin", file.bin());
    const fs::path path = folder.write(
        "test.gltf", file.json(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])")
    );
    expectLoads(loadGltf(path, {.maxVertexBytes = 1000}));
    expectRefused(loadGltf(path, {.maxVertexBytes = 20}), "its meshes need over 20 bytes");
}

TEST(GltfDocument, WrongTypesAndIndicesAreNamedByTheirField) {
    expectRefused(loadMembers(R"("nodes":{})"), "nodes is not an array");
    expectRefused(loadMembers(R"("nodes":[1])"), "nodes[0] is not an object");
    expectRefused(loadMembers(R"("nodes":[{"mesh":0}])"), "nodes[0].mesh is 0");
    expectRefused(loadMembers(R"("nodes":[{"children":[-1]}])"), "nodes[0].children[0] is -1");
    expectRefused(loadMembers(R"("nodes":[{"children":[0.5]}])"), "nodes[0].children[0] is 0.5");
    expectRefused(loadMembers(R"("nodes":[{"rotation":[0,0,1]}])"), "nodes[0].rotation has 3");
    expectRefused(loadMembers(R"("nodes":[{"scale":[0,0,"1"]}])"), "nodes[0].scale");
    expectRefused(loadMembers(R"("nodes":[{"name":5}])"), "nodes[0].name is not a string");
    expectRefused(loadMembers(R"("scene":1,"scenes":[{}])"), "scene is 1");
    expectRefused(loadMembers(R"("materials":[{"doubleSided":1}])"), "materials[0].doubleSided");
    expectRefused(loadMembers(R"("meshes":[{}])"), "meshes[0].primitives is missing");
    expectRefused(loadMembers(R"("nodes":[{"extensions":{"A":1}}])"), "nodes[0].extensions.A");
    expectRefused(loadMembers(R"("scene":18446744073709551616)"), "scene is");
}

TEST(SceneHash, TheHashChangesWithTheSceneItsBuffersAndItsPictures) {
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

TEST(SceneHash, TheHashIncludesFilesOutsideTheFolderIfTheyAreRead) {
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

TEST(SceneHash, AnInvalidSceneFileIsNamed) {
    const TempFolder folder;
    folder.write("s.gltf", "nothing");
    for (const char* name : {"s.gltf", "missing.gltf"}) {
        test::expectRefused(computeSceneHash(folder.path() / name), name);
    }
}

} // namespace
} // namespace shutter::gltf
