// SPDX-License-Identifier: MIT
// Hard cases of thin things and of open sky.
#include "assets/generator/axes.h"
#include "assets/generator/hard_stage.h"
#include "assets/generator/props.h"
#include "assets/generator/textures.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::generator {

namespace {

/// Still cables across the whole picture, sagging a little.
Shape cables() {
    Shape shape;
    int number = 0;
    for (const float height : {1.98f, 1.86f, 1.74f, 1.62f}) {
        std::vector<vec3> path;
        constexpr int kSpans = 24;
        for (int i = 0; i <= kSpans; ++i) {
            const float x = -1.0f + 2.0f * static_cast<float>(i) / kSpans;
            const float sag = 0.09f * (1.0f - x * x);
            path.emplace_back(3.0f * x, height - sag, 0.04f * static_cast<float>(number));
        }
        append(shape, tube(path, 0.0016f + 0.0012f * static_cast<float>(number), 6));
        ++number;
    }
    return shape;
}

void addSwayingGrass(GltfWriter& writer) {
    constexpr float kSway = 0.26f; // radians in an exposure
    const Index leaf = addTextured(writer, "leaf", stone({0.40f, 0.62f, 0.24f}), 0.8f);
    for (int i = 0; i < 9; ++i) {
        const float along = static_cast<float>(i);
        const float direction = i % 2 == 0 ? 1.0f : -1.0f;
        const float spin = direction * spinFor(kSway) * (0.6f + 0.4f * hash(i, 1, 7));
        // Turned back, so that it has swung upright at the case's time.
        const Index root = writer.addNode(
            {.name = fmt::format("grass_root_{}", i + 1),
             .translation = {-2.3f + 0.57f * along, 0.0f, 0.35f + 0.45f * hash(i, 0, 7)},
             .rotation = glm::angleAxis(-spin * static_cast<float>(kCaseSeconds), kZ)}
        );
        addObject(
            writer,
            {.name = fmt::format("grass_{}", i + 1), .parent = root, .angularVelocity = kZ * spin},
            grassClump(26, 0.62f, 40 + i),
            leaf
        );
    }
}

/// A ring of hills around the camera, rising from the plain.
Shape hills(float radius, float height, int seed) {
    constexpr int kColumns = 192;
    constexpr int kRows = 6;
    Shape shape;
    for (int row = 0; row <= kRows; ++row) {
        const float up = static_cast<float>(row) / kRows;
        for (int column = 0; column <= kColumns; ++column) {
            const float u = static_cast<float>(column % kColumns) / kColumns;
            const float angle = u * glm::two_pi<float>();
            const float top = height * (0.25f + fractalNoise({u * 24.0f, 0.5f}, {24, 24}, seed));
            const float away = radius * (1.0f + 0.35f * up);
            addVertex(
                shape,
                {away * std::sin(angle),
                 top * std::sin(up * glm::half_pi<float>()) - 0.3f,
                 -away * std::cos(angle)},
                kY,
                {static_cast<float>(column) / kColumns * 60.0f, 3.0f * (1.0f - up)}
            );
        }
    }
    for (size_t row = 0; row < kRows; ++row) {
        for (size_t column = 0; column < kColumns; ++column) {
            const size_t a = row * (kColumns + 1) + column;
            addTriangle(shape, a, a + 1, a + kColumns + 2);
            addTriangle(shape, a, a + kColumns + 2, a + kColumns + 1);
        }
    }
    smoothNormals(shape);
    return shape;
}

/// Trunk and crowns; the pivot is on the ground.
std::array<MeshPart, 2> tree(float height, int seed, Index bark, Index leaf) {
    std::array<MeshPart, 2> parts;
    const std::array trunk = {vec3(0.0f, -0.2f, 0.0f), vec3(0.0f, height * 0.6f, 0.0f)};
    const std::array radii = {height * 0.04f, height * 0.02f};
    parts[0] = {.shape = tube(trunk, radii, 10), .material = bark};
    for (int i = 0; i < 5; ++i) {
        const float angle = glm::two_pi<float>() * hash(i, 0, seed);
        const float reach = height * 0.16f * static_cast<float>(i > 0);
        const float size = height * (0.15f + 0.08f * hash(i, 1, seed));
        const vec3 at(
            reach * std::cos(angle),
            height * (0.60f + 0.25f * hash(i, 2, seed)),
            reach * std::sin(angle)
        );
        append(parts[1].shape, sphere(size, 16, 9), moved(at));
    }
    parts[1].material = leaf;
    return parts;
}

/// Grass with mown stripes, flowers and bare patches.
Picture meadowTexture() {
    return paint(512, 512, [](vec2 uv) {
        const float blades = noise(uv * 96.0f, {96, 96}, 141);
        const float patch = fractalNoise(uv * 6.0f, {6, 6}, 142);
        vec3 color = glm::mix(vec3(0.36f, 0.48f, 0.16f), vec3(0.62f, 0.68f, 0.28f), patch);
        if (glm::fract(uv.x * 2.0f) < 0.5f) {
            color *= 0.80f;
        }
        if (hash(static_cast<int>(uv.x * 64.0f), static_cast<int>(uv.y * 64.0f), 143) > 0.97f) {
            color = vec3(0.95f, 0.90f, 0.62f);
        }
        return color * (0.70f + 0.40f * blades);
    });
}

void addClouds(GltfWriter& writer) {
    const Index white = writer.addMaterial(
        {.name = "cloud", .color = vec3(0.85f), .roughness = 1.0f, .emissive = vec3(0.25f)}
    );
    Shape shape;

    struct Cloud {
        vec3 at;
        float size;
    };

    int number = 0;
    for (const Cloud& cloud :
         {Cloud{{-150, 118, -420}, 26}, {{95, 150, -440}, 30}, {{225, 92, -430}, 20}}) {
        for (int i = 0; i < 7; ++i) {
            const float along = static_cast<float>(i) / 3.0f - 1.0f;
            const float size =
                cloud.size * (1.0f - 0.55f * along * along) * (0.75f + 0.4f * hash(i, number, 151));
            const mat4 place = moved(cloud.at + vec3(along * cloud.size * 2.6f, size * 0.3f, 0.0f));
            append(shape, sphere(size, 16, 9), glm::scale(place, vec3(1.0f, 0.6f, 1.0f)));
        }
        ++number;
    }
    addObject(writer, {.name = "clouds"}, shape, white);
}

void addCountry(GltfWriter& writer) {
    addObject(
        writer,
        {.name = "meadow", .translation = {0.0f, -0.5f, 0.0f}},
        box({600.0f, 0.5f, 600.0f}, 9.0f),
        addTextured(writer, "meadow", meadowTexture(), 1.0f)
    );
    addObject(
        writer,
        {.name = "hills"},
        hills(260.0f, 26.0f, 161),
        addTextured(writer, "forest", stone({0.34f, 0.50f, 0.30f}), 1.0f)
    );
    const Index bark =
        addTextured(writer, "bark", wood({0.24f, 0.16f, 0.10f}, {0.44f, 0.32f, 0.22f}), 0.9f);
    const Index leaf = addTextured(writer, "leaf", stone({0.36f, 0.56f, 0.22f}), 0.9f);

    struct Tree {
        vec2 at;
        float height;
    };

    int number = 1;
    for (const Tree& place :
         {Tree{{-13, -30}, 9},
          {{-22, -38}, 11},
          {{17, -34}, 8},
          {{9, -60}, 10},
          {{-5, -75}, 12},
          {{31, -52}, 11},
          {{-46, -66}, 12},
          {{1.5f, -48}, 5}}) {
        const auto parts = tree(place.height, number, bark, leaf);
        const std::string name = fmt::format("tree_{}", number++);
        writer.addNode(
            {.name = name,
             .translation = {place.at.x, 0.0f, place.at.y},
             .mesh = writer.addMesh(name, parts)}
        );
    }
    addClouds(writer);
}

/// Envelope and basket; the pivot is the envelope's middle.
void addBalloon(GltfWriter& writer, NodeDesc node) {
    constexpr std::array<vec2, 7> kEnvelope = {
        vec2(0.55f, -3.2f),
        {1.3f, -2.2f},
        {2.3f, -0.6f},
        {2.6f, 0.8f},
        {2.0f, 2.1f},
        {0.9f, 2.8f},
        {0.0f, 2.95f}};
    constexpr std::array<vec2, 2> kMouth = {vec2(0.0f, -3.1f), kEnvelope.front()};
    std::array<MeshPart, 2> parts;
    std::vector<vec2> outline = smoothCurve(kEnvelope, 26);
    for (vec2& point : outline) {
        point.x = std::max(point.x, 0.0f);
    }
    append(parts[0].shape, withUvScale(lathe(outline, 48), {2.0f, 1.0f}));
    parts[0].material = addTextured(writer, "balloon_silk", beachBall(), 0.6f);
    append(parts[1].shape, lathe(kMouth, 24));
    append(parts[1].shape, roundedBox({0.42f, 0.34f, 0.42f}, 0.05f, 2, 0.6f), moved({0, -4.9f, 0}));
    for (const vec2 corner : {vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        const std::array rope = {
            vec3(corner.x * 0.38f, -4.65f, corner.y * 0.38f),
            vec3(corner.x * 0.36f, -3.15f, corner.y * 0.36f)};
        append(parts[1].shape, tube(rope, 0.025f, 6));
    }
    parts[1].material =
        addTextured(writer, "wicker", wood({0.36f, 0.20f, 0.09f}, {0.62f, 0.42f, 0.24f}), 0.9f);
    node.mesh = writer.addMesh("balloon", parts);
    writer.addNode(node);
}

} // namespace

GltfWriter buildThinGeometryCase() {
    GltfWriter writer("thin_geometry");
    addStillCamera(writer, kYardCaseShot);
    const CourtyardSurfaces surfaces = addYardStage(writer);
    addObject(
        writer, {.name = "cables", .translation = {0.0f, 0.0f, 2.2f}}, cables(), surfaces.iron
    );
    addObject(
        writer,
        {.name = "fence", .translation = {-1.35f, 0.62f, 1.1f}},
        wireGate({0.85f, 0.55f}, 0.0024f, {26, 15}),
        surfaces.iron
    );
    NodeDesc gate = crossingNode("gate", kYardCaseShot, {430.0f, 270.0f}, 4.0f, {18.0f, 0.0f});
    addObject(writer, gate, wireGate({0.75f, 0.50f}, 0.0034f, {22, 12}), surfaces.wood);
    addObject(
        writer,
        crossingNode("ball", kYardCaseShot, {190.0f, 236.0f}, 4.6f, {17.0f, -6.0f}),
        sphere(0.27f, 40, 24),
        addTextured(writer, "beach_ball", beachBall(), 0.45f)
    );
    addSwayingGrass(writer);
    return writer;
}

GltfWriter buildSkyHorizonCase() {
    constexpr float kPanPx = 8.0f;
    const Shot shot{
        .position = {0.0f, 2.2f, 0.0f},
        .yaw = 0.0f,
        .pitch = 0.14f,
        .yFov = 0.72f,
        .pictureSizePx = kCaseSizePx};
    GltfWriter writer("sky_horizon");
    addPanningCamera(writer, shot, kPanPx);
    addCourtyardLights(writer);
    addCountry(writer);
    // The pan moves the picture to the left by kPanPx; the balloon drifts against it.
    addBalloon(writer, crossingNode("balloon", shot, {205.0f, 135.0f}, 26.0f, {-14.0f, -4.0f}));
    NodeDesc node = crossingNode("glider", shot, {420.0f, 205.0f}, 5.0f, {32.0f, -6.0f});
    const mat4 pose = glm::rotate(glm::rotate(mat4(1.0f), 0.35f, kX), 0.3f, kY);
    node.mesh = addGliderMesh(writer, 1.5f, pose);
    writer.addNode(node);
    return writer;
}

} // namespace shutter::generator
