// SPDX-License-Identifier: MIT
// Every correct scene of shared/scenes loads, and some have the contents of their README or file.
#include "engine/gltf/gltf_loader.h"
#include "tests/support/outcomes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace shutter::gltf {
namespace {

namespace fs = std::filesystem;

const fs::path kScenesFolder = fs::path(SHUTTER_SHARED_DIR) / "scenes";

std::vector<fs::path> findScenes() {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kScenesFolder)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".gltf" || extension == ".glb")
            found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

TEST(Scenes, EveryCorrectSceneLoads) {
    if (!fs::exists(kScenesFolder))
        GTEST_SKIP() << kScenesFolder << " is missing";
    const std::vector<fs::path> scenes = findScenes();
    ASSERT_GT(scenes.size(), 50u);
    for (const fs::path& path : scenes)
        EXPECT_EQ(test::errorOf(loadGltf(path)), "");
}

struct Contents {
    size_t triangles = 0;
    size_t clips = 0;
    size_t images = 0;
    size_t joints = 0;         ///< of all skins
    size_t morphTargets = 0;   ///< of all meshes
    size_t weightChannels = 0; ///< of all clips
    size_t drawn = 0;
};

Contents count(const scene::World& world) {
    Contents contents;
    contents.clips = world.assets.clips.size();
    contents.images = world.assets.images.size();
    for (const scene::Skin& skin : world.assets.skins)
        contents.joints += skin.jointFromBind.size();
    for (const scene::Mesh& mesh : world.assets.meshes)
        contents.morphTargets += mesh.morphWeights.size();
    for (const scene::AnimationClip& clip : world.assets.clips)
        contents.weightChannels += clip.weightChannels.size();
    for (const auto& [entity, instance] : world.registry.view<const scene::MeshInstance>()) {
        contents.drawn += instance.mesh == scene::kNone ? 0 : 1;
        for (const scene::Primitive& primitive : world.assets.meshes[instance.mesh].primitives)
            contents.triangles += primitive.indices.size() / 3;
    }
    return contents;
}

struct ListedFile {
    const char* file;
    Contents contents;
    bool isDeforming; ///< else the numbers are the README's, and warnings are allowed
};

/// Without it the test's name would hold the bytes of a pointer.
void PrintTo(const ListedFile& listed, std::ostream* stream) {
    *stream << listed.file;
}

class ListedScene : public testing::TestWithParam<ListedFile> {};

TEST_P(ListedScene, EachSceneHasTheContentsOfTheReadmeOrOfItsFile) {
    const ListedFile& listed = GetParam();
    const fs::path path = kScenesFolder / listed.file;
    if (!fs::exists(path))
        GTEST_SKIP() << path << " is missing";
    const LoadedScene loaded = test::valueOf(loadGltf(path));
    const Contents found = count(loaded.world);
    const Contents& expected = listed.contents;
    if (!listed.isDeforming) {
        EXPECT_EQ(found.triangles, expected.triangles);
        EXPECT_EQ(found.clips, expected.clips);
        EXPECT_EQ(found.images, expected.images);
        return;
    }
    for (const std::string& warning : loaded.warnings)
        ADD_FAILURE() << warning;
    EXPECT_EQ(found.joints, expected.joints);
    EXPECT_EQ(found.morphTargets, expected.morphTargets);
    EXPECT_EQ(found.weightChannels, expected.weightChannels);
    EXPECT_EQ(found.drawn, expected.drawn);
}

/// By the table in shared/scenes/README.md.
ListedFile listed(const char* file, size_t triangles, size_t clips, size_t images) {
    return {file, {triangles, clips, images}, false};
}

ListedFile deforming(
    const char* file, size_t joints, size_t morphTargets, size_t weightChannels, size_t drawn
) {
    return {file, {0, 0, 0, joints, morphTargets, weightChannels, drawn}, true};
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    ListedScene,
    testing::Values(
        listed("pink-room/pink_room_lite_animated.glb", 56186, 9, 3),
        listed("grey-white-room/grey_white_room.glb", 143163, 4, 4),
        listed("gltf-samples/BoxAnimated/BoxAnimated.glb", 254, 1, 0),
        listed("gltf-samples/MeshPrimitiveModes/MeshPrimitiveModes.gltf", 16, 0, 0),
        listed("gltf-samples/CesiumMilkTruck/CesiumMilkTruck.glb", 3624, 1, 1),
        listed("gltf-samples/MultipleScenes/MultipleScenes.gltf", 2, 0, 0),
        listed("gltf-samples/TextureTransformTest/TextureTransformTest.gltf", 24, 0, 5),
        deforming("gltf-samples/CesiumMan/CesiumMan.glb", 19, 0, 0, 1),
        deforming("gltf-samples/Fox/Fox.gltf", 24, 0, 0, 1),
        deforming("gltf-samples/SimpleSkin/SimpleSkin.gltf", 2, 0, 0, 1),
        deforming("gltf-samples/SimpleMorph/SimpleMorph.gltf", 0, 2, 1, 1),
        deforming("gltf-samples/MorphStressTest/MorphStressTest.glb", 0, 8, 3, 1),
        deforming("gltf-samples/SimpleInstancing/SimpleInstancing.gltf", 0, 0, 0, 125),
        deforming("conformance/asset-generator/Animation_Skin/Animation_Skin_04.gltf", 2, 0, 0, 1),
        deforming("conformance/asset-generator/Animation_Skin/Animation_Skin_06.gltf", 2, 0, 0, 2),
        deforming("conformance/asset-generator/Animation_Skin/Animation_Skin_11.gltf", 4, 0, 0, 1)
    )
);

} // namespace
} // namespace shutter::gltf
