// SPDX-License-Identifier: MIT
// Materials, textures, samplers, pictures, tangents, and EXT_lights_image_based.
#include "engine/environment/image_based_light.h"
#include "engine/scene/particle_emitter.h"
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
    const LoadedScene scene = expectLoads(
        loadMembers(R"("materials":[{)" + json + "}]" + (rest.empty() ? "" : "," + rest))
    );
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
    const LoadedScene scene = expectLoads(loadMembers(
        R"("materials":[{"pbrMetallicRoughness":{"metallicFactor":1e30,"roughnessFactor":-1}}])"
    ));
    EXPECT_EQ(scene.world.assets.materials[0].metallicFactor, 1.0f);
    EXPECT_EQ(scene.world.assets.materials[0].roughnessFactor, 0.0f);
    EXPECT_TRUE(hasWarning(scene, "metallicFactor is 1e+30"));
}

TEST(GltfMaterial, ATextureIsDecodedOnceForAllItsUsers) {
    const LoadedScene scene = expectLoads(loadMembers(oneTexture() + R"(,"materials":[
            {"pbrMetallicRoughness":{"baseColorTexture":{"index":0},
                                     "metallicRoughnessTexture":{"index":0,"texCoord":1}}},
            {"normalTexture":{"index":0,"scale":0.5},"occlusionTexture":{"index":0,"strength":0.25},
             "emissiveTexture":{"index":0}}])"));
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
    const auto load = [](const std::string& transform) {
        return loadMembers(
            oneTexture() +
            R"(,"materials":[{"normalTexture":{"index":0,"extensions":{"KHR_texture_transform":)" +
            transform + "}}}]"
        );
    };
    expectRefused(load(R"({"offset":[1]})"), "KHR_texture_transform.offset");
    expectRefused(load(R"({"rotation":"a"})"), "KHR_texture_transform.rotation");
    expectRefused(load(R"({"scale":[1,1e300]})"), "KHR_texture_transform.scale");
    expectRefused(load("5"), "KHR_texture_transform is not an object");
}

TEST(GltfMaterial, ATextureCoordinateSetAboveOneIsDrawnWithoutItsTexture) {
    const LoadedScene scene = expectLoads(
        loadMembers(oneTexture() + R"(,"materials":[{"normalTexture":{"index":0,"texCoord":2}}])")
    );
    EXPECT_EQ(scene.world.assets.materials[0].normal.texture, scene::kNone);
    EXPECT_TRUE(hasWarning(scene, "TEXCOORD_2"));
}

TEST(GltfMaterial, SamplersSetWrapAndFilter) {
    const LoadedScene scene = expectLoads(loadMembers(
        R"("images":[)" + picture() +
        R"(],"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728},{}],
        "textures":[{"source":0,"sampler":0},{"source":0,"sampler":1}],
        "materials":[{"normalTexture":{"index":0},"emissiveTexture":{"index":1}}])"
    ));
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
}

TEST(GltfMaterial, AnUnknownWrapModeIsRefused) {
    expectRefused(
        loadMembers(
            R"("images":[)" + picture() +
            R"(],"samplers":[{"wrapS":1}],"textures":[{"source":0,"sampler":0}],
            "materials":[{"normalTexture":{"index":0}}])"
        ),
        "samplers[0].wrapS is 1"
    );
}

TEST(GltfMaterial, APictureThatDoesNotDecodeNamesFileAndImage) {
    const TempFolder folder;
    folder.write("bad.png", "not a picture");
    const std::string json =
        R"({"asset":{"version":"2.0"},"images":[{"uri":"bad.png"}],"textures":[{"source":0}],
        "materials":[{"normalTexture":{"index":0}}]})";
    const auto result = loadGltf(folder.write("test.gltf", json));
    expectRefused(result, "images[0] (bad.png)");
    expectRefused(result, "test.gltf");
}

TEST(GltfMaterial, AMissingPictureIsRefusedAndOneThatNobodyUsesIsNotOpened) {
    const std::string images = R"("images":[{"uri":"none.png"}],"textures":[{"source":0}])";
    expectRefused(
        loadMembers(images + R"(,"materials":[{"normalTexture":{"index":0}}])"), "none.png"
    );
    const LoadedScene scene = expectLoads(loadMembers(images));
    EXPECT_TRUE(scene.world.assets.images.empty());
}

TEST(GltfMaterial, APictureOutsideTheFolderIsNeverOpened) {
    const TempFolder folder;
    folder.write("secret.png", "x");
    folder.write("scene/inside.txt", "x");
    for (const char* uri : {"../secret.png", "%2e%2e/secret.png", "file:///etc/hostname"}) {
        const std::string json = fmt::format(
            R"({{"asset":{{"version":"2.0"}},"images":[{{"uri":"{}"}}],"textures":[{{"source":0}}],
            "materials":[{{"normalTexture":{{"index":0}}}}]}})",
            uri
        );
        const auto result = loadGltf(folder.write("scene/test.gltf", json));
        expectRefused(result, "images[0].uri: the URI");
    }
}

TEST(GltfMaterial, ATextureWithoutAReadablePictureIsDrawnWithoutIt) {
    const LoadedScene scene =
        expectLoads(loadMembers(R"("textures":[{}],"materials":[{"normalTexture":{"index":0}}])"));
    EXPECT_EQ(scene.world.assets.materials[0].normal.texture, scene::kNone);
    EXPECT_TRUE(hasWarning(scene, "textures[0]"));
}

/// A scene of one node that emits particles with this texture.
std::string emitting(const std::string& texture) {
    return R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"extras":{"particles":{"texture":)" +
           texture + "}}}]";
}

/// Of the only emitter.
scene::AssetIndex emittersTexture(const LoadedScene& scene) {
    size_t count = 0;
    scene::AssetIndex texture = scene::kNone;
    for (auto [entity, emitter] : scene.world.registry.view<scene::ParticleEmitter>()) {
        texture = emitter.texture;
        ++count;
    }
    EXPECT_EQ(count, 1u);
    return texture;
}

TEST(GltfMaterial, APictureThatParticlesAloneShowIsRead) {
    const std::string textures = fmt::format(
        R"("images":[{{"uri":"none.png"}},{}],"textures":[{{"source":0}},{{"source":1}}],)",
        picture()
    );
    const LoadedScene alone = expectLoads(loadMembers(textures + emitting("1")));
    const scene::Assets& assets = alone.world.assets;
    ASSERT_EQ(assets.textures.size(), 1u) << "the other one is not opened";
    EXPECT_TRUE(assets.textures[0].onParticles);
    EXPECT_EQ(
        assets.images.at(assets.textures[0].image).rgba, (std::vector<uint8_t>{200, 100, 50, 128})
    );
    EXPECT_EQ(emittersTexture(alone), 0u);
    // A material's own is shared.
    const LoadedScene shared = expectLoads(
        loadMembers(textures + emitting("1") + R"(,"materials":[{"emissiveTexture":{"index":1}}])")
    );
    ASSERT_EQ(shared.world.assets.textures.size(), 1u);
    EXPECT_TRUE(shared.world.assets.textures[0].onParticles);
    EXPECT_EQ(emittersTexture(shared), 0u);
}

TEST(GltfMaterial, APictureOfParticlesThatIsNotThereIsRefusedByName) {
    const std::string at = "nodes[0].extras.particles.texture";
    expectRefused(
        loadMembers(oneTexture() + "," + emitting("1")), at + " is 1, but there is 1 texture"
    );
    for (const char* wrong : {"-1", "0.5", "1e12", "\"puff\"", "[0]"})
        expectRefused(loadMembers(oneTexture() + "," + emitting(wrong)), at);
    expectRefused(
        loadMembers(R"("images":[{"uri":"none.png"}],"textures":[{"source":0}],)" + emitting("0")),
        "none.png"
    );
    // As a material does, they go without one that names no picture.
    const LoadedScene without = expectLoads(loadMembers(R"("textures":[{}],)" + emitting("0")));
    EXPECT_EQ(emittersTexture(without), scene::kNone);
    EXPECT_TRUE(hasWarning(without, "textures[0]"));
}

/// The triangle with normals, two texture coordinate sets and a normal map on set `uvSet`.
LoadedScene loadNormalMapped(int uvSet, const std::string& tangent = "") {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    file.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3");
    file.add(std::vector<float>{0, 1, 1, 1, 0, 0}, kFloat, "VEC2"); // u along +x
    file.add(std::vector<float>{0, 0, 0, 1, 1, 0}, kFloat, "VEC2"); // u along +y
    file.add(std::vector<float>{0, 3, 0, -1, 0, 3, 0, -1, 0, 3, 0, -1}, kFloat, "VEC4");
    return expectLoads(file.load(
        oneTexture() + fmt::format(
                           R"(,"materials":[{{"normalTexture":{{"index":0,"texCoord":{}}}}}],
            "meshes":[{{"primitives":[{{"material":0,"attributes":{{"POSITION":0,"NORMAL":1,
            "TEXCOORD_0":2,"TEXCOORD_1":3{}}}}}]}}])",
                           uvSet,
                           tangent
                       )
    ));
}

TEST(GltfMaterial, ANormalMapWithoutTangentsGetsThemFromItsOwnTextureCoordinates) {
    const LoadedScene first = loadNormalMapped(0);
    ASSERT_EQ(first.world.assets.meshes[0].primitives[0].tangents.size(), 3u);
    EXPECT_EQ(first.world.assets.meshes[0].primitives[0].tangents[0], vec4(1, 0, 0, 1));
    const LoadedScene second = loadNormalMapped(1);
    EXPECT_EQ(second.world.assets.meshes[0].primitives[0].tangents[0], vec4(0, 1, 0, 1));
}

TEST(GltfMaterial, TangentsOfTheFileAreKept) {
    const LoadedScene scene = loadNormalMapped(0, R"(,"TANGENT":4)");
    EXPECT_EQ(scene.world.assets.meshes[0].primitives[0].tangents[0], vec4(0, 1, 0, -1));
}

TEST(GltfMaterial, AMeshWithoutTheTextureCoordinatesOfItsMaterialIsWarnedOf) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    const LoadedScene scene = expectLoads(
        file.load(oneTexture() + R"(,"materials":[{"normalTexture":{"index":0,"texCoord":1}}],
        "meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":0}}]}])")
    );
    EXPECT_TRUE(hasWarning(scene, "no TEXCOORD_1"));
    EXPECT_TRUE(scene.world.assets.meshes[0].primitives[0].tangents.empty());
}

// A 1x1 RGBA PNG of (200, 100, 50, 128).
constexpr const char* kPicture = R"({"uri":"data:image/png;base64,)"
                                 "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAA"
                                 R"(DUlEQVR4nGM4kWLUAAAFNQHfc2Lj2wAAAABJRU5ErkJggg=="})";

std::string sceneWith(const std::string& light) {
    return R"("images":[)" + std::string(kPicture) +
           R"(],"extensionsUsed":["EXT_lights_image_based"],)"
           R"("extensions":{"EXT_lights_image_based":{"lights":[)" +
           light + R"(]}},"scenes":[{"extensions":{"EXT_lights_image_based":{"light":0}}}])";
}

constexpr const char* kSides = R"("specularImages":[[0,0,0,0,0,0]])";

double linear(double encoded) {
    return std::pow((encoded / 255.0 + 0.055) / 1.055, 2.4);
}

TEST(GltfEnvironment, TheEnvironmentIsReadWithRotationAndIntensity) {
    const LoadedScene scene = expectLoads(loadMembers(sceneWith(
        "{" + std::string(kSides) + R"(,"intensity":2,"rotation":[0,0.70710678,0,0.70710678]})"
    )));
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
    const auto expectField = [](const std::string& light, const std::string& field) {
        const auto loaded = loadMembers(sceneWith(light));
        ASSERT_FALSE(loaded) << light;
        EXPECT_NE(loaded.error().message.find(field), std::string::npos) << loaded.error().message;
    };
    expectField(R"({"name":"none"})", "EXT_lights_image_based.lights[0].specularImages is missing");
    expectField("7", "EXT_lights_image_based.lights");
    expectField(R"({"specularImages":7})", "specularImages");
    expectField(R"({"specularImages":[]})", "EXT_lights_image_based.lights");
    expectField(
        R"({"specularImages":[[0,0,0]]})",
        "specularImages[0] is not an array of at least 6 elements"
    );
    expectField(R"({"specularImages":[[0,0,0,0,0,9]]})", "specularImages[0][5]");
    expectField(R"({"specularImages":[[0,0,0,0,0,0.5]]})", "specularImages[0][5]");
    expectField(R"({"specularImages":[[0,0,0,0,0,-1]]})", "specularImages[0][5]");
    const std::string sides = "{" + std::string(kSides);
    expectField(sides + R"(,"rotation":[0,0,0,0]})", "rotation is no rotation");
    expectField(sides + R"(,"rotation":[0,0]})", "rotation is not an array");
    expectField(sides + R"(,"rotation":[0,"a",0,1]})", "rotation is no rotation");
    expectField(sides + R"(,"intensity":-1})", "intensity of -1");
    expectField(sides + R"(,"intensity":"a"})", "intensity");
    const auto outside =
        loadMembers(R"("extensions":{"EXT_lights_image_based":{"lights":[]}},)"
                    R"("scenes":[{"extensions":{"EXT_lights_image_based":{"light":0}}}])");
    EXPECT_FALSE(outside);
    const auto none = loadMembers(R"("scenes":[{"extensions":{"EXT_lights_image_based":{}}}])");
    EXPECT_FALSE(none);
}

} // namespace
} // namespace shutter::gltf
