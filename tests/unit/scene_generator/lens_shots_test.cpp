// SPDX-License-Identifier: MIT
// Scenes of others that are added to, and the shots that are made so.
#include "assets/generator/lens_shots.h"
#include "assets/generator/scenes.h"
#include "tests/support/rows.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>

namespace shutter::generator {
namespace {

/// A room with what the shots move in one.
std::filesystem::path writeRoom(const test::TempFolder& folder) {
    GltfWriter room("room");
    const Index material = addPlainMaterial(room, "clay", glm::vec3(0.5f), 0.8f);
    for (const char* name : {"table_vase_red", "table_vase_black"})
        addObject(room, {.name = name}, sphere(0.1f, 8, 4), material);
    const std::filesystem::path file = folder.path() / "room.glb";
    EXPECT_EQ(room.write(file), "");
    return file;
}

TEST(OpenedScene, TheSceneIsWrittenUnchangedWithTheAdditions) {
    const test::TempFolder folder;
    const std::filesystem::path room = writeRoom(folder);
    const std::filesystem::path copy = folder.path() / "copy.glb";
    EXPECT_EQ(GltfWriter::open(room).write(copy), "");
    EXPECT_EQ(std::filesystem::file_size(copy), std::filesystem::file_size(room));

    GltfWriter more = GltfWriter::open(room);
    addObject(more, {.name = "ball"}, sphere(0.1f, 8, 4), 0);
    EXPECT_EQ(more.write(copy), "");
    EXPECT_GT(std::filesystem::file_size(copy), std::filesystem::file_size(room));
    GltfWriter again = GltfWriter::open(copy);
    for (const char* name : {"table_vase_red", "ball"})
        again.moveNode(name, glm::vec3(1.0f));
    EXPECT_EQ(again.write(copy), "");
}

TEST(OpenedScene, MissingFilesAndNodesAreNamed) {
    const test::TempFolder folder;
    const std::filesystem::path out = folder.path() / "out.glb";
    const std::filesystem::path text =
        folder.write("text.glb", "glTF is what this is not, nor JSON");
    for (const std::filesystem::path& wrong : {text, folder.path() / "nosuch.glb"})
        EXPECT_NE(GltfWriter::open(wrong).write(out).find(wrong.string()), std::string::npos);
    GltfWriter room = GltfWriter::open(writeRoom(folder));
    room.moveNode("nosuch", glm::vec3(1.0f));
    EXPECT_NE(room.write(out).find("nosuch"), std::string::npos);
}

/// A binary glTF file with an empty buffer.
std::string packGlb(std::string text) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto word = [](size_t value) {
        const auto narrow = static_cast<uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&narrow), sizeof(narrow));
    };
    return "glTF" + word(2) + word(12 + 8 + text.size() + 8) + word(text.size()) + "JSON" + text +
           word(0) + std::string("BIN\0", 4);
}

TEST(OpenedScene, DocumentsThatCannotBeExtendedAreRefused) {
    const test::TempFolder folder;
    const std::filesystem::path out = folder.path() / "out.glb";
    const auto furnish = [&](const std::string& members) {
        GltfWriter writer = GltfWriter::open(folder.write("in.glb", packGlb("{" + members + "}")));
        listLensShots().front().furnish(writer);
        return writer.write(out);
    };
    const std::string valid = R"("buffers": [{"byteLength": 0}], "scenes": [{"nodes": []}])";
    EXPECT_EQ(furnish(valid), "");
    for (const std::string& members : test::rowsOf(
             R"("extensionsUsed": {}|"extensionsUsed": "x"|"nodes": {}|"nodes": [1]|)"
             R"("nodes": [{"name": 5}]|"nodes": [{"extensions": []}]|)"
             R"("nodes": [{"extensions": {"KHR_physics_rigid_bodies": 1}}]|"materials": 3|)"
             R"("accessors": {}|"bufferViews": "x"|"meshes": [[]]|"cameras": [null])"
         ))
        EXPECT_NE(furnish(valid + ", " + members).find("in.glb"), std::string::npos) << members;
    const std::string buffers = R"("buffers": [{"byteLength": 0}])";
    for (const char* scenes :
         {"", R"(, "scenes": {})", R"(, "scenes": [{}, {}])", R"(, "scenes": [{"nodes": {}}])"})
        EXPECT_NE(furnish(buffers + scenes).find("in.glb"), std::string::npos) << scenes;
    for (const char* wrong : {R"([{"uri": "a.bin"}])", R"({"a": {}})"}) {
        const std::string members = "\"buffers\": " + std::string(wrong);
        const std::string refused = furnish(members + R"(, "scenes": [{"nodes": []}])");
        EXPECT_NE(refused.find("in.glb"), std::string::npos) << wrong;
    }
}

TEST(LensShots, EachFurnishesARoom) {
    const test::TempFolder folder;
    const std::filesystem::path room = writeRoom(folder);
    std::set<std::string> names;
    for (const LensShot& shot : listLensShots()) {
        EXPECT_TRUE(names.insert(shot.name).second) << shot.name;
        GltfWriter writer = GltfWriter::open(room);
        shot.furnish(writer);
        EXPECT_EQ(writer.write(folder.path() / "out.glb"), "") << shot.name;
    }
}

} // namespace
} // namespace shutter::generator
