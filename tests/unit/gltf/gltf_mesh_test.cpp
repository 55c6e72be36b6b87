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
    LoadedScene loaded = expectLoads(loadMesh(file, primitive));
    if (loaded.world.assets.meshes.size() != 1 ||
        loaded.world.assets.meshes[0].primitives.size() != 1) {
        ADD_FAILURE() << "no primitive";
        return {};
    }
    scene::Primitive first = loaded.world.assets.meshes[0].primitives[0];
    if (scene)
        *scene = std::move(loaded);
    return first;
}

size_t countPrimitives(const LoadedScene& scene) {
    return scene.world.assets.meshes.at(0).primitives.size();
}

const std::string kPosition = R"("attributes":{"POSITION":0})";

TEST(GltfMesh, ATriangleWithoutIndicesHasFlatNormalsAndBounds) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
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
    const std::string primitive = R"("attributes":{"POSITION":0,"NORMAL":0},"indices":1)";
    GltfFile bytes;
    bytes.add(kTriangle, kFloat, "VEC3");
    bytes.add(std::vector<uint8_t>{2, 0, 1}, kUnsignedByte, "SCALAR");
    GltfFile shorts;
    shorts.add(kTriangle, kFloat, "VEC3");
    shorts.add(std::vector<uint16_t>{2, 0, 1}, kUnsignedShort, "SCALAR");
    GltfFile ints;
    ints.add(kTriangle, kFloat, "VEC3");
    ints.add(std::vector<uint32_t>{2, 0, 1}, kUnsignedInt, "SCALAR");
    for (const GltfFile* file : {&bytes, &shorts, &ints}) {
        EXPECT_EQ(readPrimitive(*file, primitive).indices, (std::vector<uint32_t>{2, 0, 1}));
    }
}

TEST(GltfMesh, IndicesPastTheVerticesSignedOnesAndFloatsAreRefused) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    file.add(std::vector<uint16_t>{0, 1, 3}, kUnsignedShort, "SCALAR");
    file.add(std::vector<float>{0, 1, 2}, kFloat, "SCALAR");
    file.add(std::vector<int16_t>{0, 1, 2}, kShort, "SCALAR");
    const std::string named[] = {
        "meshes[0].primitives[0].indices holds 3", "componentType 5126", "componentType 5122"};
    for (int i = 0; i < 3; ++i)
        expectRefused(loadMesh(file, kPosition + fmt::format(R"(,"indices":{})", i + 1)), named[i]);
}

TEST(GltfMesh, StripsAndFansBecomeTriangles) {
    GltfFile file;
    file.add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, kFloat, "VEC3");
    const std::string attributes = R"("attributes":{"POSITION":0,"NORMAL":0})";
    EXPECT_EQ(
        readPrimitive(file, attributes + R"(,"mode":5)").indices,
        (std::vector<uint32_t>{0, 1, 2, 1, 3, 2})
    );
    EXPECT_EQ(
        readPrimitive(file, attributes + R"(,"mode":6)").indices,
        (std::vector<uint32_t>{1, 2, 0, 2, 3, 0})
    );
}

TEST(GltfMesh, PointsAndLinesAreSkippedWithAWarning) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    for (const int mode : {0, 1, 2, 3}) {
        const LoadedScene scene =
            expectLoads(loadMesh(file, kPosition + fmt::format(R"(,"mode":{})", mode)));
        EXPECT_EQ(countPrimitives(scene), 0u);
        EXPECT_TRUE(scene.world.assets.meshes[0].bounds.isEmpty());
        EXPECT_TRUE(hasWarning(scene, "points and lines"));
    }
    expectRefused(loadMesh(file, kPosition + R"(,"mode":7)"), "mode 7");
}

TEST(GltfMesh, AListThatEndsWithinATriangleIsDrawnUpToThere) {
    GltfFile file;
    file.add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9}, kFloat, "VEC3");
    LoadedScene scene;
    EXPECT_EQ(readPrimitive(file, kPosition, &scene).indices.size(), 3u);
    EXPECT_TRUE(hasWarning(scene, "ends within a triangle"));
}

TEST(GltfMesh, APrimitiveWithoutPositionsIsSkipped) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    const LoadedScene scene = expectLoads(loadMesh(file, R"("attributes":{"NORMAL":0})"));
    EXPECT_EQ(countPrimitives(scene), 0u);
    EXPECT_TRUE(hasWarning(scene, "no POSITION"));
}

TEST(GltfMesh, TrianglesWithNaNOrInfinityAreDropped) {
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        GltfFile file;
        std::vector<float> positions = kTriangle;
        positions.insert(positions.end(), {0, 0, 0, 1, bad, 0, 0, 1, 0});
        file.add(positions, kFloat, "VEC3");
        LoadedScene scene;
        const scene::Primitive primitive = readPrimitive(file, kPosition, &scene);
        EXPECT_EQ(primitive.positions.size(), 3u);
        EXPECT_EQ(scene.world.assets.meshes[0].bounds.max, math::dvec3(1, 1, 0));
        EXPECT_TRUE(hasWarning(scene, "1 triangle is not drawn"));
    }
}

TEST(GltfMesh, AttributesOfTheWrongTypeOrCountAreRefused) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
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

TEST(GltfMesh, TextureCoordinatesAndColoursComeAsFloatsOrNormalizedIntegers) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
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
}

TEST(GltfMesh, ColoursOutsideTheirRangeAreClamped) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    const float nan = std::nanf("");
    file.add(std::vector<float>{2, -1, nan, 0.5f, 1, 1, 1, 1, 1, 1, 1, 1}, kFloat, "VEC4");
    LoadedScene scene;
    const scene::Primitive primitive =
        readPrimitive(file, R"("attributes":{"POSITION":0,"NORMAL":0,"COLOR_0":1})", &scene);
    EXPECT_EQ(primitive.colors[0], vec4(1.0f, 0.0f, 0.0f, 0.5f));
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
        expectLoads(file.load(R"("extensionsUsed":["KHR_mesh_quantization"],)" + primitive));
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

TEST(GltfMesh, SparseValuesReplaceTheDenseOnes) {
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
}

TEST(GltfMesh, SparseIndicesHaveToIncreaseAndStayInside) {
    for (const std::vector<uint16_t>& indices :
         {std::vector<uint16_t>{1, 3}, std::vector<uint16_t>{2, 1}, std::vector<uint16_t>{1, 1}}) {
        GltfFile file;
        file.addView(indices);
        file.addView(std::vector<float>{1, 0, 0, 0, 1, 0});
        file.addAccessor(R"({"componentType":5126,"count":3,"type":"VEC3",
            "sparse":{"count":2,"indices":{"bufferView":0,"componentType":5123},
                      "values":{"bufferView":1}}})");
        expectRefused(loadMesh(file, kPosition), "sparse.indices holds");
    }
}

class BadAccessor : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(BadAccessor, ABadAccessorIsRefused) {
    GltfFile file;
    file.addView(kTriangle); // 36 bytes
    file.addViewJson(R"({"buffer":0,"byteLength":36,"byteStride":16})");
    file.addViewJson(R"({"buffer":0,"byteLength":36,"byteStride":4})");
    file.addAccessor(GetParam().first);
    expectRefused(file.load(""), GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(
    Accessors,
    BadAccessor,
    testing::Values(
        std::pair(R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})", "reads past"),
        std::pair(
            R"({"bufferView":0,"byteOffset":4,"componentType":5126,"count":3,"type":"VEC3"})",
            "reads past"
        ),
        std::pair(
            R"({"bufferView":0,"byteOffset":40,"componentType":5126,"count":1,"type":"VEC3"})",
            "reads past"
        ),
        std::pair(R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"})", "reads past"),
        std::pair(
            R"({"bufferView":2,"componentType":5126,"count":1,"type":"VEC3"})", "byteStride 4"
        ),
        std::pair(R"({"bufferView":0,"componentType":5126,"count":0,"type":"VEC3"})", "count is 0"),
        std::pair(
            R"({"bufferView":0,"componentType":5126,"count":9007199254740992,"type":"VEC3"})",
            "reads past"
        ),
        std::pair(
            R"({"bufferView":0,"componentType":5130,"count":1,"type":"VEC3"})", "componentType 5130"
        ),
        std::pair(
            R"({"bufferView":0,"componentType":5126,"count":1,"type":"VEC5"})", "'VEC5', not one of"
        ),
        std::pair(
            R"({"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":4,
            "indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}})",
            "sparse.count is 4"
        ),
        std::pair(
            R"({"componentType":5126,"count":9,"type":"VEC3","sparse":{"count":4,
            "indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}})",
            "sparse.values reads past"
        ),
        std::pair(
            R"({"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
            "indices":{"bufferView":0,"componentType":5120},"values":{"bufferView":0}}})",
            "no unsigned integer"
        )
    )
);

TEST(GltfMesh, ABufferViewPastItsBufferAndAHugeAccessorOfZerosAreRefused) {
    GltfFile file;
    file.addView(kTriangle);
    file.addViewJson(R"({"buffer":0,"byteOffset":4294967290,"byteLength":100})");
    expectRefused(file.load(""), "bufferViews[1] reads bytes");
    GltfFile zeros;
    zeros.addAccessor(R"({"componentType":5126,"count":100000000,"type":"VEC3"})");
    expectRefused(loadMesh(zeros, kPosition), "without a bufferView");
}

TEST(GltfMesh, GivenNormalsAreNormalizedAndZeroOnesReplaced) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    file.add(std::vector<float>{0, 0, 0, 2, 0, 0, 0, 0.5f, 0}, kFloat, "VEC3");
    LoadedScene scene;
    const scene::Primitive primitive =
        readPrimitive(file, R"("attributes":{"POSITION":0,"NORMAL":1})", &scene);
    EXPECT_EQ(primitive.normals[0], vec3(0, 0, 1));
    EXPECT_EQ(primitive.normals[1], vec3(1, 0, 0));
    EXPECT_EQ(primitive.normals[2], vec3(0, 1, 0));
    EXPECT_TRUE(hasWarning(scene, "NORMAL holds 1 vector without"));
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

TEST(Triangulate, AListKeepsItsTrianglesAndDropsTheRest) {
    const Indices indices = {0, 1, 2, 3, 4, 5, 6, 7};
    EXPECT_EQ(triangulate(indices, TriangleMode::List), (Indices{0, 1, 2, 3, 4, 5}));
    EXPECT_TRUE(triangulate({}, TriangleMode::List).empty());
    EXPECT_TRUE(triangulate(Indices{1}, TriangleMode::List).empty());
}

TEST(Triangulate, AStripTurnsEverySecondTriangleRound) {
    const Indices indices = {0, 1, 2, 3, 4};
    EXPECT_EQ(triangulate(indices, TriangleMode::Strip), (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    EXPECT_TRUE(triangulate(Indices{0, 1}, TriangleMode::Strip).empty());
    EXPECT_TRUE(triangulate({}, TriangleMode::Strip).empty());
}

TEST(Triangulate, AFanTurnsRoundItsFirstVertex) {
    const Indices indices = {0, 1, 2, 3};
    EXPECT_EQ(triangulate(indices, TriangleMode::Fan), (Indices{1, 2, 0, 2, 3, 0}));
    EXPECT_TRUE(triangulate(Indices{0, 1}, TriangleMode::Fan).empty());
}

TEST(Triangulate, TrianglesWithAnIndexTwiceAreLeftOut) {
    EXPECT_TRUE(triangulate(Indices{0, 0, 1}, TriangleMode::List).empty());
    // Two strips joined by repeated vertices keep their own triangles only.
    EXPECT_EQ(
        triangulate(Indices{0, 1, 2, 2, 3, 3, 4, 5}, TriangleMode::Strip),
        (Indices{0, 1, 2, 3, 5, 4})
    );
}

TEST(FlatNormals, EveryTriangleGetsItsOwnVerticesAndItsFaceNormal) {
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
}

TEST(FlatNormals, TinyAndHugeTrianglesHaveNormalsAndOnesWithoutAreaAreUnit) {
    for (const float size : {1e-40f, 1e-20f, 1e30f}) {
        scene::Primitive primitive = makeTriangle();
        for (vec3& position : primitive.positions)
            position *= size;
        makeFlatNormals(primitive);
        expectVec(primitive.normals[0], {0, 0, 1});
    }
    scene::Primitive flat = makeTriangle();
    flat.positions[2] = {2, 0, 0};
    makeFlatNormals(flat);
    EXPECT_NEAR(glm::length(flat.normals[0]), 1.0f, 1e-6f);
}

TEST(RepairNormals, GoodOnesAreNormalizedAndBadOnesTakeTheirFaces) {
    scene::Primitive primitive = makeTriangle();
    primitive.normals = {{0, 0, 0}, {3, 0, 0}, {0, std::nanf(""), 0}};
    EXPECT_EQ(repairNormals(primitive), 2u);
    expectVec(primitive.normals[0], {0, 0, 1});
    expectVec(primitive.normals[1], {1, 0, 0});
    expectVec(primitive.normals[2], {0, 0, 1});
    EXPECT_EQ(repairNormals(primitive), 0u);
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

TEST(RemoveNonFinite, OnlyTrianglesWithANonFiniteVertexAreRemoved) {
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        scene::Primitive primitive;
        primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {bad, 0, 0}};
        primitive.colors = {vec4(0), vec4(1), vec4(2), vec4(3)};
        primitive.indices = {0, 1, 3, 2, 1, 0};
        EXPECT_EQ(removeNonFiniteTriangles(primitive), 1u);
        ASSERT_EQ(primitive.positions.size(), 3u);
        EXPECT_EQ(primitive.indices, (Indices{0, 1, 2}));
        EXPECT_EQ(primitive.positions[0], vec3(0, 1, 0));
        EXPECT_EQ(primitive.colors[0], vec4(2));
    }
}

TEST(Tangents, AnUprightTextureHasItsTangentAlongUAndAPositiveSign) {
    scene::Primitive primitive = makeTriangle();
    primitive.normals.assign(3, {0, 0, 1});
    // glTF's v grows downwards: a picture seen upright has u right and v down.
    makeTangents(primitive, {{0, 1}, {1, 1}, {0, 0}});
    for (const vec4& tangent : primitive.tangents) {
        expectVec(vec3(tangent), {1, 0, 0});
        EXPECT_EQ(tangent.w, 1.0f);
    }
}

TEST(Tangents, AMirroredTextureHasANegativeSign) {
    scene::Primitive primitive = makeTriangle();
    primitive.normals.assign(3, {0, 0, 1});
    makeTangents(primitive, {{1, 1}, {0, 1}, {1, 0}});
    expectVec(vec3(primitive.tangents[0]), {-1, 0, 0});
    EXPECT_EQ(primitive.tangents[0].w, -1.0f);
}

TEST(Tangents, TangentsAreOrthogonalToASlantedNormal) {
    scene::Primitive primitive = makeTriangle();
    primitive.normals.assign(3, glm::normalize(vec3(1, 0, 1)));
    makeTangents(primitive, {{0, 1}, {1, 1}, {0, 0}});
    expectVec(vec3(primitive.tangents[0]), glm::normalize(vec3(1, 0, -1)));
}

TEST(Tangents, TangentsWithoutUsableTextureCoordinatesAreUnitAndOrthogonal) {
    scene::Primitive primitive = makeTriangle();
    primitive.normals = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    makeTangents(primitive, {{0, 0}, {0, 0}, {0, 0}});
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(glm::length(vec3(primitive.tangents[i])), 1.0f, 1e-6f);
        EXPECT_NEAR(glm::dot(vec3(primitive.tangents[i]), primitive.normals[i]), 0.0f, 1e-6f);
    }
}

TEST(Tangents, GivenOnesAreCheckedAndNormalized) {
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
