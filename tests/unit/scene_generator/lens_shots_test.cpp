// SPDX-License-Identifier: MIT
// Scenes of others that are added to, and the shots that are made so.
#include "assets/generator/lens_shots.h"
#include "assets/generator/scenes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

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

TEST(OpenedScene, IsWrittenAsItWasWithWhatIsAdded) {
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

TEST(OpenedScene, NamesTheFileAndTheNodeThatAreNotThere) {
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
