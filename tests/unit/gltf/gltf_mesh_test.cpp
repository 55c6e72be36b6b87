// SPDX-License-Identifier: MIT
// Accessors and primitives: from numbers in a file to triangles.
#include "engine/gltf/gltf_geometry.h"
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace shutter::gltf {
namespace {

using math::vec2;
using math::vec3;
using math::vec4;

std::string mesh(const std::string& primitive) {
    return R"("meshes":[{"primitives":[{)" + primitive + "}]}]";
}

core::Result<LoadedScene> loadMesh(const GltfFile& file, const std::string& primitive) {
    return file.load(mesh(primitive));
}

/// The only primitive of the only mesh.
scene::Primitive
readPrimitive(const GltfFile& file, const std::string& primitive, LoadedScene* scene = nullptr) {
    LoadedScene loaded = file.read(mesh(primitive));
    scene::Primitive first = primitiveOf(loaded);
    EXPECT_EQ(loaded.world.assets.meshes.size(), 1u);
    EXPECT_EQ(loaded.world.assets.meshes[0].primitives.size(), 1u);
    if (scene)
        *scene = std::move(loaded);
    return first;
}

size_t countPrimitives(const LoadedScene& scene) {
    return scene.world.assets.meshes.at(0).primitives.size();
}

/// Accessor 0: positions.
GltfFile makeFile(const std::vector<float>& positions = kTriangle) {
    GltfFile file;
    file.add(positions, kFloat, "VEC3");
    return file;
}

const std::string kPosition = R"("attributes":{"POSITION":0})";

TEST(GltfMesh, ATriangleWithoutIndicesHasFlatNormalsAndBounds) {
    GltfFile file = makeFile();
    LoadedScene scene;
    const scene::Primitive primitive = readPrimitive(file, kPosition, &scene);
    EXPECT_EQ(primitive.indices, (std::vector<uint32_t>{0, 1, 2}));
    ASSERT_EQ(primitive.normals.size(), 3u);
    EXPECT_EQ(primitive.normals[0], vec3(0, 0, 1));
    EXPECT_EQ(primitive.material, scene::kNone);
    EXPECT_TRUE(primitive.tangents.empty());
    EXPECT_EQ(scene.world.assets.meshes[0].bounds.max, math::dvec3(1, 1, 0));
    EXPECT_EQ(scene.world.assets.meshes[0].bounds.min, math::dvec3(0, 0, 0));
}

TEST(GltfMesh, IndicesOfOneTwoAndFourBytesAreRead) {
    GltfFile file = makeFile();
    file.add(std::vector<uint8_t>{2, 0, 1}, kUnsignedByte, "SCALAR");
    file.add(std::vector<uint16_t>{2, 0, 1}, kUnsignedShort, "SCALAR");
    file.add(std::vector<uint32_t>{2, 0, 1}, kUnsignedInt, "SCALAR");
    for (const char* indices : {"1", "2", "3"}) {
        const std::string primitive = R"("attributes":{"POSITION":0,"NORMAL":0},"indices":)";
        EXPECT_EQ(
            readPrimitive(file, primitive + indices).indices, (std::vector<uint32_t>{2, 0, 1})
        );
    }
}

TEST(GltfMesh, IndicesPastTheVerticesSignedOnesAndFloatsAreRefused) {
    GltfFile file = makeFile();
    file.add(std::vector<uint16_t>{0, 1, 3}, kUnsignedShort, "SCALAR");
    file.add(std::vector<float>{0, 1, 2}, kFloat, "SCALAR");
    file.add(std::vector<int16_t>{0, 1, 2}, kShort, "SCALAR");
    const std::string named[] = {
        "meshes[0].primitives[0].indices holds 3", "componentType 5126", "componentType 5122"};
    for (int i = 0; i < 3; ++i)
        expectRefused(loadMesh(file, kPosition + fmt::format(R"(,"indices":{})", i + 1)), named[i]);
}

TEST(GltfMesh, StripsAndFansBecomeTriangles) {
    const GltfFile file = makeFile({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    const auto indices = [&](const char* mode) {
        const std::string primitive = R"("attributes":{"POSITION":0,"NORMAL":0},"mode":)";
        return readPrimitive(file, primitive + mode).indices;
    };
    EXPECT_EQ(indices("5"), (std::vector<uint32_t>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(indices("6"), (std::vector<uint32_t>{1, 2, 0, 2, 3, 0}));
}

TEST(GltfMesh, WhatCannotBeDrawnIsSkippedWithAWarning) {
    const GltfFile file = makeFile();
    for (const int mode : {0, 1, 2, 3}) {
        const LoadedScene scene = file.read(mesh(kPosition + fmt::format(R"(,"mode":{})", mode)));
        EXPECT_EQ(countPrimitives(scene), 0u);
        EXPECT_TRUE(scene.world.assets.meshes[0].bounds.isEmpty());
        EXPECT_TRUE(hasWarning(scene, "points and lines"));
    }
    expectRefused(loadMesh(file, kPosition + R"(,"mode":7)"), "mode 7");
    const LoadedScene placeless = file.read(mesh(R"("attributes":{"NORMAL":0})"));
    EXPECT_EQ(countPrimitives(placeless), 0u);
    EXPECT_TRUE(hasWarning(placeless, "no POSITION"));
    LoadedScene scene;
    const GltfFile longer = makeFile({0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9});
    EXPECT_EQ(readPrimitive(longer, kPosition, &scene).indices.size(), 3u);
    EXPECT_TRUE(hasWarning(scene, "ends within a triangle"));
}

TEST(GltfMesh, TrianglesWithNaNOrInfinityAreDroppedWithWhatBelongsToTheirVertices) {
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        GltfFile file = makeFile({0, 0, 0, 1, 0, 0, 0, 1, 0, bad, 0, 0});
        file.add(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, kFloat, "VEC3");
        file.add(std::vector<uint16_t>{0, 1, 3, 2, 1, 0}, kUnsignedShort, "SCALAR");
        LoadedScene scene;
        const scene::Primitive primitive = readPrimitive(
            file, R"("attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":1},"indices":2)", &scene
        );
        ASSERT_EQ(primitive.positions.size(), 3u);
        EXPECT_EQ(primitive.indices, (std::vector<uint32_t>{0, 1, 2}));
        EXPECT_EQ(primitive.positions[0], vec3(0, 1, 0));
        EXPECT_EQ(primitive.colors[0], vec4(0, 0, 1, 1));
        EXPECT_EQ(scene.world.assets.meshes[0].bounds.max, math::dvec3(1, 1, 0));
        EXPECT_TRUE(hasWarning(scene, "1 triangle is not drawn"));
    }
}

TEST(GltfMesh, AttributesOfTheWrongTypeOrCountAreRefused) {
    GltfFile file = makeFile();
    file.add(std::vector<float>{0, 0, 1, 0, 0, 1}, kFloat, "VEC2");
    file.add(std::vector<uint16_t>(9), kUnsignedShort, "VEC3");
    file.add(std::vector<uint8_t>(6), kUnsignedByte, "VEC2"); // not normalized
    file.add(std::vector<float>{0, 0, 1}, kFloat, "VEC3");
    const auto refuse = [&](const std::string& attributes, const char* part) {
        expectRefused(loadMesh(file, R"("attributes":{"POSITION":)" + attributes + "}"), part);
    };
    refuse("1", "POSITION: accessors[1].type");
    refuse("2", "componentType 5123");
    refuse(R"(0,"TEXCOORD_0":0)", "accessors[0].type");
    refuse(R"(0,"TEXCOORD_0":3)", "not normalized");
    refuse(R"(0,"NORMAL":4)", "NORMAL has 1 element, POSITION");
}

TEST(GltfMesh, TextureCoordinatesAndColoursComeAsFloatsOrNormalizedIntegersClamped) {
    GltfFile file = makeFile();
    file.add(std::vector<float>{0, 0.25f, 0.5f, 1, 2, -3}, kFloat, "VEC2");
    file.add(std::vector<uint16_t>{0, 65535, 0, 0, 0, 0}, kUnsignedShort, "VEC2", true);
    const std::vector<uint8_t> bytes = {255, 0, 51, 0, 0, 0, 255, 255, 255};
    // Three-byte colours are padded to four by a stride in real files; here they are packed.
    file.add(bytes, kUnsignedByte, "VEC3", true);
    const scene::Primitive primitive = readPrimitive(
        file, R"("attributes":{"POSITION":0,"NORMAL":0,"TEXCOORD_0":1,"TEXCOORD_1":2,"COLOR_0":3})"
    );
    EXPECT_EQ(primitive.uv0[2], vec2(2, -3));
    EXPECT_EQ(primitive.uv1[0], vec2(0, 1));
    EXPECT_EQ(primitive.colors[0], vec4(1.0f, 0.0f, 0.2f, 1.0f));
    EXPECT_EQ(primitive.colors[2], vec4(1.0f));
    GltfFile bright = makeFile();
    const float nan = std::nanf("");
    bright.add(std::vector<float>{2, -1, nan, 0.5f, 1, 1, 1, 1, 1, 1, 1, 1}, kFloat, "VEC4");
    LoadedScene scene;
    const scene::Primitive clamped =
        readPrimitive(bright, R"("attributes":{"POSITION":0,"NORMAL":0,"COLOR_0":1})", &scene);
    EXPECT_EQ(clamped.colors[0], vec4(1.0f, 0.0f, 0.0f, 0.5f));
    EXPECT_TRUE(hasWarning(scene, "COLOR_0 leaves [0, 1]"));
}

TEST(GltfMesh, QuantizedPositionsAndNormalsNeedTheExtension) {
    GltfFile file;
    file.add(std::vector<int16_t>{0, 0, 0, 0, 300, 0, 0, 0, 0, 300, 0, 0}, kShort, "VEC4");
    file.add(std::vector<int16_t>{0, 0, 0, 300, 0, 0, 0, 300, 0}, kShort, "VEC3");
    file.add(std::vector<int8_t>{0, 0, 127, 0, 0, 127, 0, 0, -128}, kByte, "VEC3", true);
    const std::string primitive = mesh(R"("attributes":{"POSITION":1,"NORMAL":2})");
    expectRefused(file.load(primitive), "componentType 5122");
    const LoadedScene scene =
        file.read(R"("extensionsUsed":["KHR_mesh_quantization"],)" + primitive);
    ASSERT_EQ(countPrimitives(scene), 1u);
    const scene::Primitive& quantized = scene.world.assets.meshes[0].primitives[0];
    EXPECT_EQ(quantized.positions[1], vec3(300, 0, 0));
    EXPECT_EQ(quantized.normals[0], vec3(0, 0, 1));
    EXPECT_EQ(quantized.normals[2], vec3(0, 0, -1)) << "-128 / 127 clamps to -1";
}

TEST(GltfMesh, InterleavedAttributesShareAView) {
    GltfFile file;
    const std::vector<float> vertices = {0, 0, 0, 0.1f, 0.2f, 1, 0, 0, 0.3f, 0.4f, 0, 1, 0, 5, 6};
    file.addView(vertices);
    file.addViewJson(R"({"buffer":0,"byteLength":60,"byteStride":20})");
    file.addAccessor(R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"})");
    file.addAccessor(
        R"({"bufferView":1,"byteOffset":12,"componentType":5126,"count":3,"type":"VEC2"})"
    );
    const scene::Primitive primitive =
        readPrimitive(file, R"("attributes":{"POSITION":0,"NORMAL":0,"TEXCOORD_0":1})");
    EXPECT_EQ(primitive.positions[2], vec3(0, 1, 0));
    EXPECT_EQ(primitive.uv0[1], vec2(0.3f, 0.4f));
    EXPECT_EQ(primitive.uv0[2], vec2(5, 6));
}

TEST(GltfMesh, SparseValuesReplaceTheDenseOnesAndTheirIndicesIncreaseAndStayInside) {
    GltfFile file;
    file.addView(kTriangle);
    file.addView(std::vector<uint8_t>{1});
    file.addView(std::vector<float>{7, 0, 0});
    file.addAccessor(R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
        "sparse":{"count":1,"indices":{"bufferView":1,"componentType":5121},
                  "values":{"bufferView":2}}})");
    const scene::Primitive primitive = readPrimitive(file, kPosition);
    EXPECT_EQ(primitive.positions[1], vec3(7, 0, 0));
    EXPECT_EQ(primitive.positions[2], vec3(0, 1, 0));
    for (const std::vector<uint16_t>& indices :
         {std::vector<uint16_t>{1, 3}, std::vector<uint16_t>{2, 1}, std::vector<uint16_t>{1, 1}}) {
        GltfFile wrong;
        wrong.addView(indices);
        wrong.addView(std::vector<float>{1, 0, 0, 0, 1, 0});
        wrong.addAccessor(R"({"componentType":5126,"count":3,"type":"VEC3",
            "sparse":{"count":2,"indices":{"bufferView":0,"componentType":5123},
                      "values":{"bufferView":1}}})");
        expectRefused(loadMesh(wrong, kPosition), "sparse.indices holds");
    }
}

TEST(GltfMesh, BadAccessorsAreRefused) {
    const std::pair<const char*, const char*> kBad[] = {
        {R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")", "reads past"},
        {R"("bufferView":0,"byteOffset":4,"componentType":5126,"count":3,"type":"VEC3")",
         "reads past"},
        {R"("bufferView":0,"byteOffset":40,"componentType":5126,"count":1,"type":"VEC3")",
         "reads past"},
        {R"("bufferView":1,"componentType":5126,"count":3,"type":"VEC3")", "reads past"},
        {R"("bufferView":2,"componentType":5126,"count":1,"type":"VEC3")", "byteStride 4"},
        {R"("bufferView":0,"componentType":5126,"count":0,"type":"VEC3")", "count is 0"},
        {R"("bufferView":0,"componentType":5126,"count":9007199254740992,"type":"VEC3")",
         "reads past"},
        {R"("bufferView":0,"componentType":5130,"count":1,"type":"VEC3")", "componentType 5130"},
        {R"("bufferView":0,"componentType":5126,"count":1,"type":"VEC5")", "'VEC5', not one of"},
        {R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":4,
            "indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}})",
         "sparse.count is 4"},
        {R"("componentType":5126,"count":9,"type":"VEC3","sparse":{"count":4,
            "indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}})",
         "sparse.values reads past"},
        {R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
            "indices":{"bufferView":0,"componentType":5120},"values":{"bufferView":0}})",
         "no unsigned integer"}};
    for (const auto& [accessor, sentence] : kBad) {
        SCOPED_TRACE(accessor);
        GltfFile file;
        file.addView(kTriangle); // 36 bytes
        file.addViewJson(R"({"buffer":0,"byteLength":36,"byteStride":16})");
        file.addViewJson(R"({"buffer":0,"byteLength":36,"byteStride":4})");
        file.addAccessor("{" + std::string(accessor) + "}");
        expectRefused(file.load(""), sentence);
    }
}

TEST(GltfMesh, ABufferViewPastItsBufferAndAHugeAccessorOfZerosAreRefused) {
    GltfFile file;
    file.addView(kTriangle);
    file.addViewJson(R"({"buffer":0,"byteOffset":4294967290,"byteLength":100})");
    expectRefused(file.load(""), "bufferViews[1] reads bytes");
    GltfFile zeros;
    zeros.addAccessor(R"({"componentType":5126,"count":100000000,"type":"VEC3"})");
    expectRefused(loadMesh(zeros, kPosition), "without a bufferView");
}

TEST(GltfMesh, GivenNormalsAreNormalizedAndThoseWithoutDirectionTakeTheirFaces) {
    GltfFile file = makeFile();
    file.add(std::vector<float>{0, 0, 0, 3, 0, 0, 0, std::nanf(""), 0}, kFloat, "VEC3");
    LoadedScene scene;
    const auto normals =
        readPrimitive(file, R"("attributes":{"POSITION":0,"NORMAL":1})", &scene).normals;
    EXPECT_EQ(normals, (std::vector<vec3>{vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 0, 1)}));
    EXPECT_TRUE(hasWarning(scene, "NORMAL holds 2 vectors without"));
}

using Indices = std::vector<uint32_t>;

scene::Primitive makeTriangle() {
    scene::Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    primitive.indices = {0, 1, 2};
    return primitive;
}

void expectVec(const vec3& actual, const vec3& expected) {
    EXPECT_NEAR(glm::distance(actual, expected), 0.0f, 1e-5f)
        << actual.x << " " << actual.y << " " << actual.z;
}

TEST(Triangulate, ListsStripsAndFansBecomeTrianglesOfThreeDifferentVertices) {
    struct Row {
        TriangleMode mode;
        Indices indices;
        Indices triangles;
    };

    const Row kRows[] = {
        {TriangleMode::List, {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5}}, // the rest is dropped
        {TriangleMode::List, {}, {}},
        {TriangleMode::List, {1}, {}},
        {TriangleMode::List, {0, 0, 1}, {}},
        {TriangleMode::Strip, {0, 1, 2, 3, 4}, {0, 1, 2, 1, 3, 2, 2, 3, 4}},
        {TriangleMode::Strip, {0, 1}, {}},
        {TriangleMode::Strip, {}, {}},
        // Two strips joined by repeated vertices keep their own triangles only.
        {TriangleMode::Strip, {0, 1, 2, 2, 3, 3, 4, 5}, {0, 1, 2, 3, 5, 4}},
        {TriangleMode::Fan, {0, 1, 2, 3}, {1, 2, 0, 2, 3, 0}}, // round its first vertex
        {TriangleMode::Fan, {0, 1}, {}}};
    for (const Row& row : kRows)
        EXPECT_EQ(triangulate(row.indices, row.mode), row.triangles);
}

TEST(FlatNormals, EveryTriangleGetsItsOwnVerticesAndItsFaceNormalHoweverSmallOrLargeItIs) {
    scene::Primitive primitive;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    primitive.uv0 = {{0, 0}, {1, 0}, {0, 1}, {5, 5}};
    primitive.indices = {0, 1, 2, 0, 2, 3};
    makeFlatNormals(primitive);
    ASSERT_EQ(primitive.positions.size(), 6u);
    expectVec(primitive.normals[0], {0, 0, 1});
    expectVec(primitive.normals[2], {0, 0, 1});
    expectVec(primitive.normals[3], {1, 0, 0});
    EXPECT_EQ(primitive.uv0[5], vec2(5, 5));
    EXPECT_EQ(primitive.indices, (Indices{0, 1, 2, 3, 4, 5}));
    for (const float size : {1e-40f, 1e-20f, 1e30f}) {
        scene::Primitive scaled = makeTriangle();
        for (vec3& position : scaled.positions)
            position *= size;
        makeFlatNormals(scaled);
        expectVec(scaled.normals[0], {0, 0, 1});
    }
    scene::Primitive flat = makeTriangle();
    flat.positions[2] = {2, 0, 0};
    makeFlatNormals(flat);
    EXPECT_NEAR(glm::length(flat.normals[0]), 1.0f, 1e-6f);
}

TEST(GatherVertices, InfluencesAndMorphTargetsFollowTheirVertices) {
    scene::Primitive primitive;
    primitive.positions = {vec3(0), vec3(1), vec3(2)};
    primitive.influenceCount = 4;
    primitive.joints = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    primitive.weights.assign(12, 0.25f);
    primitive.weights[11] = 0.5f;
    primitive.morphTargets = {{{vec3(3), vec3(4), vec3(5)}, {}, {vec3(6), vec3(7), vec3(8)}}, {}};
    const Indices sources = {2, 0, 2};
    const scene::Primitive gathered = gatherVertices(primitive, sources);
    EXPECT_EQ(gathered.influenceCount, 4u);
    EXPECT_EQ(gathered.joints, (std::vector<uint16_t>{8, 9, 10, 11, 0, 1, 2, 3, 8, 9, 10, 11}));
    EXPECT_EQ(gathered.weights[3], 0.5f);
    EXPECT_EQ(gathered.weights[7], 0.25f);
    ASSERT_EQ(gathered.morphTargets.size(), 2u);
    EXPECT_EQ(gathered.morphTargets[0].positions, (std::vector<vec3>{vec3(5), vec3(3), vec3(5)}));
    EXPECT_TRUE(gathered.morphTargets[0].normals.empty());
    EXPECT_EQ(gathered.morphTargets[0].tangents[0], vec3(8));
    EXPECT_TRUE(gathered.morphTargets[1].positions.empty());
}

TEST(Tangents, TangentsPointAlongUOrthogonalToTheNormalWithTheSignOfTheTexture) {
    struct Row {
        vec3 normal;
        std::vector<vec2> uv;
        vec4 tangent;
    };

    // glTF's v grows downwards: a picture seen upright has u right and v down.
    const std::vector<vec2> upright = {{0, 1}, {1, 1}, {0, 0}};
    const vec3 slanted = glm::normalize(vec3(1, 0, 1));
    for (const Row& row :
         {Row{{0, 0, 1}, upright, {1, 0, 0, 1}},
          Row{{0, 0, 1}, {{1, 1}, {0, 1}, {1, 0}}, {-1, 0, 0, -1}}, // mirrored
          Row{slanted, upright, vec4(glm::normalize(vec3(1, 0, -1)), 1)}}) {
        scene::Primitive primitive = makeTriangle();
        primitive.normals.assign(3, row.normal);
        makeTangents(primitive, row.uv);
        for (const vec4& tangent : primitive.tangents) {
            expectVec(vec3(tangent), vec3(row.tangent));
            EXPECT_EQ(tangent.w, row.tangent.w);
        }
    }
}

TEST(Tangents, TangentsWithoutUsableTextureCoordinatesAreUnitAndOrthogonalAndGivenOnesNormalized) {
    scene::Primitive primitive = makeTriangle();
    primitive.normals = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    makeTangents(primitive, {{0, 0}, {0, 0}, {0, 0}});
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(glm::length(vec3(primitive.tangents[i])), 1.0f, 1e-6f);
        EXPECT_NEAR(glm::dot(vec3(primitive.tangents[i]), primitive.normals[i]), 0.0f, 1e-6f);
    }
    EXPECT_FALSE(areTangentsValid({vec4(0, 0, 0, 1)}));
    EXPECT_FALSE(areTangentsValid({vec4(std::nanf(""), 0, 0, 1)}));
    std::vector<vec4> tangents = {vec4(2, 0, 0, -0.5f), vec4(0, 1, 0, 0)};
    ASSERT_TRUE(areTangentsValid(tangents));
    normalizeTangents(tangents);
    EXPECT_EQ(tangents[0], vec4(1, 0, 0, -1));
    EXPECT_EQ(tangents[1], vec4(0, 1, 0, 1));
}

} // namespace
} // namespace shutter::gltf
