// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace shutter::gltf {

namespace {

using Indices = std::vector<uint32_t>;
using math::vec2;
using math::vec3;
using math::vec4;

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

TEST(RemoveNonFinite, OnlyTheTrianglesThatHoldTheVertexGo) {
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

TEST(Tangents, TheyAreOrthogonalToASlantedNormal) {
    scene::Primitive primitive = makeTriangle();
    primitive.normals.assign(3, glm::normalize(vec3(1, 0, 1)));
    makeTangents(primitive, {{0, 1}, {1, 1}, {0, 0}});
    expectVec(vec3(primitive.tangents[0]), glm::normalize(vec3(1, 0, -1)));
}

TEST(Tangents, WithoutAUsableTextureCoordinateTheyAreStillUnitAndOrthogonal) {
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
