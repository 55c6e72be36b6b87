// SPDX-License-Identifier: MIT
// Every correct scene of shared/scenes loads, and a few have the contents listed in their README.
#include "engine/gltf/gltf_loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
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

size_t countTriangles(const scene::World& world) {
    size_t triangles = 0;
    for (const auto& [entity, instance] : world.registry.view<const scene::MeshInstance>()) {
        for (const scene::Primitive& primitive : world.assets.meshes[instance.mesh].primitives) {
            triangles += primitive.indices.size() / 3;
        }
    }
    return triangles;
}

struct Expectation {
    const char* file;
    size_t triangles;
    size_t clips;
    size_t images;
};

/// Without it the test's name would hold the bytes of a pointer.
void PrintTo(const Expectation& expectation, std::ostream* stream) {
    *stream << expectation.file;
}

// The numbers of the table in shared/scenes/README.md.
class ListedScene : public testing::TestWithParam<Expectation> {};

TEST_P(ListedScene, EachSceneHasTheTrianglesClipsAndPicturesOfTheReadme) {
    const Expectation& expected = GetParam();
    const fs::path path = kScenesFolder / expected.file;
    if (!fs::exists(path))
        GTEST_SKIP() << path << " is missing";
    const core::Result<LoadedScene> loaded = loadGltf(path);
    ASSERT_TRUE(loaded) << loaded.error().message;
    const scene::World& world = loaded.value().world;
    EXPECT_EQ(countTriangles(world), expected.triangles);
    EXPECT_EQ(world.assets.clips.size(), expected.clips);
    EXPECT_EQ(world.assets.images.size(), expected.images);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    ListedScene,
    testing::Values(
        Expectation{"pink-room/pink_room_lite_animated.glb", 56186, 9, 3},
        Expectation{"grey-white-room/grey_white_room.glb", 143163, 4, 4},
        Expectation{"gltf-samples/BoxAnimated/BoxAnimated.glb", 254, 1, 0},
        Expectation{"gltf-samples/MeshPrimitiveModes/MeshPrimitiveModes.gltf", 16, 0, 0},
        Expectation{"gltf-samples/CesiumMilkTruck/CesiumMilkTruck.glb", 3624, 1, 1},
        Expectation{"gltf-samples/MultipleScenes/MultipleScenes.gltf", 2, 0, 0},
        Expectation{"gltf-samples/TextureTransformTest/TextureTransformTest.gltf", 24, 0, 5}
    )
);

TEST(Scenes, EveryCorrectSceneLoads) {
    if (!fs::exists(kScenesFolder))
        GTEST_SKIP() << kScenesFolder << " is missing";
    const std::vector<fs::path> scenes = findScenes();
    ASSERT_GT(scenes.size(), 50u);
    for (const fs::path& path : scenes) {
        const core::Result<LoadedScene> loaded = loadGltf(path);
        EXPECT_TRUE(loaded) << loaded.error().message;
    }
}

struct Moving {
    const char* file;
    size_t joints;         ///< of all skins
    size_t morphTargets;   ///< of all meshes
    size_t weightChannels; ///< of all clips
    size_t drawn;
};

void PrintTo(const Moving& moving, std::ostream* stream) {
    *stream << moving.file;
}

class DeformingScene : public testing::TestWithParam<Moving> {};

TEST_P(DeformingScene, EachSceneLoadsWithoutWarningsWithTheContentsOfItsFile) {
    const Moving& expected = GetParam();
    const fs::path path = kScenesFolder / expected.file;
    if (!fs::exists(path))
        GTEST_SKIP() << path << " is missing";
    const core::Result<LoadedScene> loaded = loadGltf(path);
    ASSERT_TRUE(loaded) << loaded.error().message;
    for (const std::string& warning : loaded.value().warnings)
        ADD_FAILURE() << warning;
    const scene::World& world = loaded.value().world;
    size_t joints = 0;
    for (const scene::Skin& skin : world.assets.skins)
        joints += skin.jointFromBind.size();
    EXPECT_EQ(joints, expected.joints);
    size_t targets = 0;
    for (const scene::Mesh& mesh : world.assets.meshes)
        targets += mesh.morphWeights.size();
    EXPECT_EQ(targets, expected.morphTargets);
    size_t channels = 0;
    for (const scene::AnimationClip& clip : world.assets.clips)
        channels += clip.weightChannels.size();
    EXPECT_EQ(channels, expected.weightChannels);
    size_t drawn = 0;
    for (const auto& [entity, instance] : world.registry.view<const scene::MeshInstance>())
        drawn += instance.mesh == scene::kNone ? 0 : 1;
    EXPECT_EQ(drawn, expected.drawn);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    DeformingScene,
    testing::Values(
        Moving{"gltf-samples/CesiumMan/CesiumMan.glb", 19, 0, 0, 1},
        Moving{"gltf-samples/Fox/Fox.gltf", 24, 0, 0, 1},
        Moving{"gltf-samples/SimpleSkin/SimpleSkin.gltf", 2, 0, 0, 1},
        Moving{"gltf-samples/SimpleMorph/SimpleMorph.gltf", 0, 2, 1, 1},
        Moving{"gltf-samples/MorphStressTest/MorphStressTest.glb", 0, 8, 3, 1},
        Moving{"gltf-samples/SimpleInstancing/SimpleInstancing.gltf", 0, 0, 0, 125},
        Moving{"conformance/asset-generator/Animation_Skin/Animation_Skin_04.gltf", 2, 0, 0, 1},
        Moving{"conformance/asset-generator/Animation_Skin/Animation_Skin_06.gltf", 2, 0, 0, 2},
        Moving{"conformance/asset-generator/Animation_Skin/Animation_Skin_11.gltf", 4, 0, 0, 1}
    )
);

} // namespace

} // namespace shutter::gltf
