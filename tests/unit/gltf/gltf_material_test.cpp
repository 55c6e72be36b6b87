// SPDX-License-Identifier: MIT
// Materials, textures, samplers, pictures, tangents, and EXT_lights_image_based.
#include "engine/environment/image_based_light.h"
#include "tests/support/outcomes.h"
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::gltf {
namespace {

using math::vec2;
using math::vec3;
using math::vec4;

// A 1x1 RGBA PNG of (200, 100, 50, 128).
constexpr const char* kPng = "data:image/png;base64,"
                             "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAA"
                             "DUlEQVR4nGM4kWLUAAAFNQHfc2Lj2wAAAABJRU5ErkJggg==";

std::string picture() {
    return fmt::format(R"({{"uri":"{}"}})", kPng);
}

std::string oneTexture() {
    return fmt::format(R"("images":[{}],"textures":[{{"source":0}}])", picture());
}

scene::Material readMaterial(const std::string& json, const std::string& rest = "") {
    const LoadedScene scene =
        readMembers(R"("materials":[{)" + json + "}]" + (rest.empty() ? "" : "," + rest));
    return scene.world.assets.materials.empty() ? scene::Material()
                                                : scene.world.assets.materials[0];
}

TEST(GltfMaterial, AnEmptyMaterialHasTheDefaultsOfTheSpecification) {
    const scene::Material material = readMaterial("");
    EXPECT_EQ(material.baseColorFactor, vec4(1.0f));
    EXPECT_EQ(material.metallicFactor, 1.0f);
    EXPECT_EQ(material.roughnessFactor, 1.0f);
    EXPECT_EQ(material.emissive, vec3(0.0f));
    EXPECT_EQ(material.alphaMode, scene::AlphaMode::Opaque);
    EXPECT_EQ(material.alphaCutoff, 0.5f);
    EXPECT_FALSE(material.doubleSided);
    EXPECT_FALSE(material.unlit);
    EXPECT_EQ(material.baseColor.texture, scene::kNone);
}

TEST(GltfMaterial, ABlendModeStandsBeforeTheMaterialsOwn) {
    const auto read = [](const std::string& mode) {
        return readMaterial(
            R"("alphaMode":"MASK","extensions":{"OMI_materials_blend":{)" + mode + "}}"
        );
    };
    const scene::Material added = read(R"("alphaMode":"ADD")");
    EXPECT_EQ(added.alphaMode, scene::AlphaMode::Blend);
    EXPECT_EQ(added.blendMode, scene::BlendMode::Add);
    EXPECT_EQ(read(R"("alphaMode":"PREMULT")").blendMode, scene::BlendMode::Premultiplied);
    EXPECT_EQ(read(R"("alphaMode":"BLEND")").alphaMode, scene::AlphaMode::Blend);
    // Modes that are not drawn fall back, as the draft requires.
    for (const char* mode : {R"("alphaMode":"MULTIPLY")", ""})
        EXPECT_EQ(read(mode).alphaMode, scene::AlphaMode::Mask) << mode;
}

TEST(GltfMaterial, FactorsAndSwitchesAreRead) {
    const scene::Material material = readMaterial(
        R"("name":"paint","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],
        "metallicFactor":0.5,"roughnessFactor":0.25},"emissiveFactor":[1,0.5,0],
        "alphaMode":"MASK","alphaCutoff":0.75,"doubleSided":true,
        "extensions":{"KHR_materials_unlit":{},
                      "KHR_materials_emissive_strength":{"emissiveStrength":8}})"
    );
    EXPECT_EQ(material.name, "paint");
    EXPECT_EQ(material.baseColorFactor, vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallicFactor, 0.5f);
    EXPECT_EQ(material.roughnessFactor, 0.25f);
    EXPECT_EQ(material.emissive, vec3(8.0f, 4.0f, 0.0f));
    EXPECT_EQ(material.alphaMode, scene::AlphaMode::Mask);
    EXPECT_EQ(material.alphaCutoff, 0.75f);
    EXPECT_TRUE(material.doubleSided);
    EXPECT_TRUE(material.unlit);
    EXPECT_EQ(readMaterial(R"("alphaMode":"BLEND")").alphaMode, scene::AlphaMode::Blend);
    expectRefused(loadMembers(R"("materials":[{"alphaMode":"SPARKLE"}])"), "alphaMode 'SPARKLE'");
}

TEST(GltfMaterial, FactorsOutOfRangeAreClampedWithAWarning) {
    const LoadedScene scene = readMembers(
        R"("materials":[{"pbrMetallicRoughness":{"metallicFactor":1e30,"roughnessFactor":-1}}])"
    );
    EXPECT_EQ(scene.world.assets.materials[0].metallicFactor, 1.0f);
    EXPECT_EQ(scene.world.assets.materials[0].roughnessFactor, 0.0f);
    EXPECT_TRUE(hasWarning(scene, "metallicFactor is 1e+30"));
}

TEST(GltfMaterial, ATextureIsDecodedOnceForAllItsUsers) {
    const LoadedScene scene = readMembers(oneTexture() + R"(,"materials":[
            {"pbrMetallicRoughness":{"baseColorTexture":{"index":0},
                                     "metallicRoughnessTexture":{"index":0,"texCoord":1}}},
            {"normalTexture":{"index":0,"scale":0.5},"occlusionTexture":{"index":0,"strength":0.25},
             "emissiveTexture":{"index":0}}])");
    const scene::Assets& assets = scene.world.assets;
    ASSERT_EQ(assets.images.size(), 1u);
    ASSERT_EQ(assets.textures.size(), 1u);
    EXPECT_EQ(assets.images[0].rgba, (std::vector<uint8_t>{200, 100, 50, 128}));
    EXPECT_EQ(assets.materials[0].baseColor.texture, 0u);
    EXPECT_EQ(assets.materials[0].metallicRoughness.texture, 0u);
    EXPECT_EQ(assets.materials[0].metallicRoughness.uvSet, 1u);
    EXPECT_EQ(assets.materials[1].normal.texture, 0u);
    EXPECT_EQ(assets.materials[1].normalScale, 0.5f);
    EXPECT_EQ(assets.materials[1].occlusion.texture, 0u);
    EXPECT_EQ(assets.materials[1].occlusionStrength, 0.25f);
    EXPECT_EQ(assets.materials[1].emissiveTexture.texture, 0u);
}

TEST(GltfMaterial, ATextureTransformIsFoldedIntoTheSlot) {
    const scene::Material material = readMaterial(
        R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":0,"extensions":{
            "KHR_texture_transform":{"offset":[0.5,0.25],"rotation":1.5,"scale":[2,-3],
                                     "texCoord":1}}}})",
        oneTexture()
    );
    EXPECT_EQ(material.baseColor.offset, vec2(0.5f, 0.25f));
    EXPECT_EQ(material.baseColor.scale, vec2(2.0f, -3.0f));
    EXPECT_EQ(material.baseColor.rotation, 1.5f);
    EXPECT_EQ(material.baseColor.uvSet, 1u);
}

TEST(GltfMaterial, AMalformedTextureTransformIsNamed) {
    expectEachRefused(
        [](const std::string& transform) {
            return loadMembers(
                oneTexture() +
                R"(,"materials":[{"normalTexture":{"index":0,"extensions":{"KHR_texture_transform":)" +
                transform + "}}}]"
            );
        },
        {{R"({"offset":[1]})", "KHR_texture_transform.offset"},
         {R"({"rotation":"a"})", "KHR_texture_transform.rotation"},
         {R"({"scale":[1,1e300]})", "KHR_texture_transform.scale"},
         {"5", "KHR_texture_transform is not an object"}}
    );
}

/// A material whose normals are the picture of texture 0.
const std::string kNormalMapped = R"("materials":[{"normalTexture":{"index":0}}])";

TEST(GltfMaterial, ATextureThatCannotBeShownIsLeftOut) {
    const LoadedScene far =
        readMembers(oneTexture() + R"(,"materials":[{"normalTexture":{"index":0,"texCoord":2}}])");
    EXPECT_EQ(far.world.assets.materials[0].normal.texture, scene::kNone);
    EXPECT_TRUE(hasWarning(far, "TEXCOORD_2"));
    const LoadedScene pictureless = readMembers(R"("textures":[{}],)" + kNormalMapped);
    EXPECT_EQ(pictureless.world.assets.materials[0].normal.texture, scene::kNone);
    EXPECT_TRUE(hasWarning(pictureless, "textures[0]"));
}

TEST(GltfMaterial, SamplersSetWrapAndFilterAndAnUnknownWrapModeIsRefused) {
    const LoadedScene scene = readMembers(
        R"("images":[)" + picture() +
        R"(],"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728},{}],
        "textures":[{"source":0,"sampler":0},{"source":0,"sampler":1}],
        "materials":[{"normalTexture":{"index":0},"emissiveTexture":{"index":1}}])"
    );
    const std::vector<scene::Texture>& textures = scene.world.assets.textures;
    ASSERT_EQ(textures.size(), 2u);
    const scene::Material& material = scene.world.assets.materials[0];
    const scene::Texture& first = textures[material.normal.texture];
    EXPECT_EQ(first.wrapU, scene::Wrap::ClampToEdge);
    EXPECT_EQ(first.wrapV, scene::Wrap::MirroredRepeat);
    EXPECT_TRUE(first.nearest);
    const scene::Texture& second = textures[material.emissiveTexture.texture];
    EXPECT_EQ(second.wrapU, scene::Wrap::Repeat);
    EXPECT_FALSE(second.nearest);
    EXPECT_EQ(scene.world.assets.images.size(), 1u);
    expectRefused(
        loadMembers(
            R"("images":[)" + picture() +
            R"(],"samplers":[{"wrapS":1}],"textures":[{"source":0,"sampler":0}],)" + kNormalMapped
        ),
        "samplers[0].wrapS is 1"
    );
}

TEST(GltfMaterial, PicturesThatAreMissingDamagedOrOutsideTheFolderAreNamed) {
    const TempFolder folder;
    folder.write("secret.png", "x");
    folder.write("scene/bad.png", "not a picture");
    const auto load = [&](const std::string& uri, const std::string& material = kNormalMapped) {
        return loadGltf(folder.write(
            "scene/test.gltf",
            R"({"asset":{"version":"2.0"},"images":[{"uri":")" + uri +
                R"("}],"textures":[{"source":0}])" + (material.empty() ? "" : "," + material) + "}"
        ));
    };
    expectRefused(load("bad.png"), "images[0] (bad.png)");
    expectRefused(load("bad.png"), "test.gltf");
    expectRefused(load("none.png"), "none.png");
    // One that nobody uses is not opened.
    EXPECT_TRUE(expectLoads(load("none.png", "")).world.assets.images.empty());
    for (const char* uri : {"../secret.png", "%2e%2e/secret.png", "file:///etc/hostname"})
        expectRefused(load(uri), "images[0].uri: the URI");
}

/// The triangle with normals, two texture coordinate sets and a normal map on set `uvSet`.
LoadedScene loadNormalMapped(int uvSet, const std::string& tangent = "") {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    file.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3");
    file.add(std::vector<float>{0, 1, 1, 1, 0, 0}, kFloat, "VEC2"); // u along +x
    file.add(std::vector<float>{0, 0, 0, 1, 1, 0}, kFloat, "VEC2"); // u along +y
    file.add(std::vector<float>{0, 3, 0, -1, 0, 3, 0, -1, 0, 3, 0, -1}, kFloat, "VEC4");
    return file.read(
        oneTexture() + fmt::format(
                           R"(,"materials":[{{"normalTexture":{{"index":0,"texCoord":{}}}}}],
            "meshes":[{{"primitives":[{{"material":0,"attributes":{{"POSITION":0,"NORMAL":1,
            "TEXCOORD_0":2,"TEXCOORD_1":3{}}}}}]}}])",
                           uvSet,
                           tangent
                       )
    );
}

TEST(GltfMaterial, ANormalMapTakesTheTangentsOfTheFileOrOnesFromItsOwnTextureCoordinates) {
    const LoadedScene first = loadNormalMapped(0);
    ASSERT_EQ(first.world.assets.meshes[0].primitives[0].tangents.size(), 3u);
    EXPECT_EQ(first.world.assets.meshes[0].primitives[0].tangents[0], vec4(1, 0, 0, 1));
    const LoadedScene second = loadNormalMapped(1);
    EXPECT_EQ(second.world.assets.meshes[0].primitives[0].tangents[0], vec4(0, 1, 0, 1));
    const LoadedScene given = loadNormalMapped(0, R"(,"TANGENT":4)");
    EXPECT_EQ(given.world.assets.meshes[0].primitives[0].tangents[0], vec4(0, 1, 0, -1));
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    const LoadedScene without =
        file.read(oneTexture() + R"(,"materials":[{"normalTexture":{"index":0,"texCoord":1}}],
        "meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":0}}]}])");
    EXPECT_TRUE(hasWarning(without, "no TEXCOORD_1"));
    EXPECT_TRUE(without.world.assets.meshes[0].primitives[0].tangents.empty());
}

std::string sceneWith(const std::string& light) {
    return R"("images":[)" + picture() +
           R"(],"extensionsUsed":["EXT_lights_image_based"],)"
           R"("extensions":{"EXT_lights_image_based":{"lights":[)" +
           light + R"(]}},"scenes":[{"extensions":{"EXT_lights_image_based":{"light":0}}}])";
}

constexpr const char* kSides = R"("specularImages":[[0,0,0,0,0,0]])";

double linear(double encoded) {
    return std::pow((encoded / 255.0 + 0.055) / 1.055, 2.4);
}

TEST(GltfEnvironment, TheEnvironmentIsReadWithRotationAndIntensity) {
    const LoadedScene scene = readMembers(sceneWith(
        "{" + std::string(kSides) + R"(,"intensity":2,"rotation":[0,0.70710678,0,0.70710678]})"
    ));
    ASSERT_TRUE(scene.world.assets.environment.has_value());
    const scene::Environment& environment = *scene.world.assets.environment;
    const math::vec3 seen = environment::evaluateIrradiance(environment.irradiance, {0, 1, 0});
    // RGBD: twice as bright as its colours, and twice that by the intensity.
    EXPECT_NEAR(seen.x, linear(200) * 255.0 / 128.0 * 2.0, 1e-2);
    EXPECT_NEAR(seen.y, linear(100) * 255.0 / 128.0 * 2.0, 1e-2);
    // Turned by 90 degrees about +Y: what the map has ahead is seen on the left.
    const math::vec3 sampled = environment.mapFromWorld * math::vec3(-1, 0, 0);
    EXPECT_LT(glm::distance(sampled, math::vec3(0, 0, -1)), 1e-5f);
}

TEST(GltfEnvironment, AnInvalidEnvironmentIsRefusedWithTheField) {
    const std::string sides = "{" + std::string(kSides);
    expectEachRefused(
        [](const std::string& light) { return loadMembers(sceneWith(light)); },
        {{R"({"name":"none"})", "EXT_lights_image_based.lights[0].specularImages is missing"},
         {"7", "EXT_lights_image_based.lights"},
         {R"({"specularImages":7})", "specularImages"},
         {R"({"specularImages":[]})", "EXT_lights_image_based.lights"},
         {R"({"specularImages":[[0,0,0]]})",
          "specularImages[0] is not an array of at least 6 elements"},
         {R"({"specularImages":[[0,0,0,0,0,9]]})", "specularImages[0][5]"},
         {R"({"specularImages":[[0,0,0,0,0,0.5]]})", "specularImages[0][5]"},
         {R"({"specularImages":[[0,0,0,0,0,-1]]})", "specularImages[0][5]"},
         {sides + R"(,"rotation":[0,0,0,0]})", "rotation is no rotation"},
         {sides + R"(,"rotation":[0,0]})", "rotation is not an array"},
         {sides + R"(,"rotation":[0,"a",0,1]})", "rotation is no rotation"},
         {sides + R"(,"intensity":-1})", "intensity of -1"},
         {sides + R"(,"intensity":"a"})", "intensity"}}
    );
    EXPECT_FALSE(loadMembers(sceneWith("")));
    EXPECT_FALSE(loadMembers(R"("scenes":[{"extensions":{"EXT_lights_image_based":{}}}])"));
}

} // namespace
} // namespace shutter::gltf
