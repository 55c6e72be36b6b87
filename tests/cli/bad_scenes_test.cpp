// SPDX-License-Identifier: MIT
// Scenes that cannot be drawn: exit status 1, a sentence that names the file, no picture.
#include "tests/cli/cli_fixture.h"

namespace shutter::cli {

namespace {

/// One triangle whose positions are `bytes` long in a buffer view of 36.
std::string makeTriangle(size_t bytes, const std::string& more) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0})" +
           std::string(more.empty() ? "" : R"(, "material": 0)") + R"(}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": )" +
           std::to_string(bytes) + R"(, "uri": "points.bin"}])" + more + "}";
}

/// Textures the triangle with `file`.
std::string makeMaterial(const std::string& file) {
    return R"(, "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": ")" +
           file + R"("}])";
}

class CliScenes : public Cli {
  protected:
    void SetUp() override { requireDevice(); }

    void expectSceneRefusal(const std::string& file, const Arguments& mentions) const {
        expectRefusal(
            {"render",
             file,
             "--size",
             "64x36",
             "--out",
             "a.png",
             "--stats",
             "s.json",
             "--device",
             "llvmpipe"},
            kFailed,
            mentions
        );
        expectRefusal({"info", file}, kFailed, mentions);
    }
};

} // namespace

TEST_F(CliScenes, AMisspeltMemberOfTheExtrasIsWarnedOfWithItsFile) {
    writeFile(
        "misspelt.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"camera": 0}], "cameras": [{"type": "perspective",
        "perspective": {"yfov": 0.7, "znear": 0.1}, "extras": {"lens": {"fstop": 2}, "id": 3}}]})"
    );
    const Outcome drawn = run(
        {"render",
         "misspelt.gltf",
         "--size",
         "64x36",
         "--method",
         "sharp",
         "--out",
         path("a.png"),
         "--device",
         "llvmpipe"}
    );
    EXPECT_EQ(drawn.status, 0);
    EXPECT_EQ(
        drawn.err,
        "shutter: warning: misspelt.gltf: cameras[0].extras.lens has a member 'fstop': not used\n"
    );
}

TEST_F(CliScenes, AFileOutsideTheFolderIsReadOnlyWhereThatIsAllowed) {
    fs::create_directory(path("sub"));
    std::string scene = makeTriangle(36, "");
    scene.replace(scene.find("points.bin"), 0, "../");
    writeFile("sub/scene.gltf", scene);
    writeFile("points.bin", std::string(36, '\0'));
    expectSceneRefusal("sub/scene.gltf", {"sub/scene.gltf", "../points.bin", "leaves"});
    expectSuccess({"info", "sub/scene.gltf", "--allow-outside"});
}

TEST_F(CliScenes, ReplayOfAMissingDumpNamesItWithAMethodAndWithout) {
    requireDevice();
    expectRefusal({"replay", "missing"}, kFailed, {"missing"});
    expectRefusal({"replay", "missing", "--method", "gather"}, kFailed, {"missing"});
}

TEST_F(CliScenes, AMissingFileIsNamed) {
    expectSceneRefusal("nosuch.glb", {"nosuch.glb"});
    expectSceneRefusal("nosuch/scene.gltf", {"nosuch/scene.gltf"});
}

TEST_F(CliScenes, AFolderIsNoScene) {
    fs::create_directory(path("folder.glb"));
    expectSceneRefusal("folder.glb", {"folder.glb"});
}

TEST_F(CliScenes, AnEmptyFileIsNoScene) {
    writeFile("empty.glb", "");
    writeFile("empty.gltf", "");
    expectSceneRefusal("empty.glb", {"empty.glb"});
    expectSceneRefusal("empty.gltf", {"empty.gltf"});
}

TEST_F(CliScenes, AFileOfAnotherKindIsNoScene) {
    writeFile("text.gltf", "a shopping list\n");
    writeFile("text.glb", "a shopping list\n");
    writeFile("half.gltf", R"({"asset": {"version": "2.0")");
    writeFile("other.gltf", R"({"name": "valid JSON, no glTF"})");
    for (const char* file : {"text.gltf", "text.glb", "half.gltf", "other.gltf"})
        expectSceneRefusal(file, {file});
}

TEST_F(CliScenes, ARequiredExtensionThatIsNotSupportedIsNamed) {
    writeFile(
        "extension.gltf",
        R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_nosuch"],
            "extensionsRequired": ["EXT_nosuch"]})"
    );
    expectSceneRefusal("extension.gltf", {"extension.gltf", "EXT_nosuch"});
}

TEST_F(CliScenes, ABufferThatIsShorterThanItsViewsIsRefused) {
    writeFile("points.bin", std::string(20, '\0'));
    writeFile("declared.gltf", makeTriangle(20, ""));
    writeFile("actual.gltf", makeTriangle(36, ""));
    expectSceneRefusal("declared.gltf", {"declared.gltf", "bufferViews"});
    expectSceneRefusal("actual.gltf", {"actual.gltf", "buffers[0]"});
}

TEST_F(CliScenes, AMissingBufferIsRefused) {
    writeFile("missing.gltf", makeTriangle(36, ""));
    expectSceneRefusal("missing.gltf", {"missing.gltf", "points.bin"});
}

TEST_F(CliScenes, AnImageThatDoesNotDecodeIsRefused) {
    writeFile("points.bin", std::string(36, '\0'));
    writeFile("noise.png", "this is no picture");
    writeFile("image.gltf", makeTriangle(36, makeMaterial("noise.png")));
    writeFile("none.gltf", makeTriangle(36, makeMaterial("nosuch.png")));
    expectSceneRefusal("image.gltf", {"image.gltf", "noise.png"});
    expectSceneRefusal("none.gltf", {"none.gltf", "nosuch.png"});
}

TEST_F(CliScenes, AnEmptySceneIsDrawnAsBackground) {
    writeFile("nothing.gltf", R"({"asset": {"version": "2.0"}})");
    expectSuccess(
        {"render", "nothing.gltf", "--size", "16x16", "--out", "a.png", "--device", "llvmpipe"}
    );
    EXPECT_TRUE(listFiles().contains("a.png"));
}

} // namespace shutter::cli
