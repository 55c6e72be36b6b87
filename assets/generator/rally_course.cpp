// SPDX-License-Identifier: MIT
// The way of the rally and the land around it.
#include "assets/generator/axes.h"
#include "assets/generator/demo_scenes.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/scenes.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace shutter::generator {

namespace {

constexpr std::array kGates = {
    vec2(0, 0),
    vec2(0, -40),
    vec2(0, -80),
    vec2(18, -112),
    vec2(52, -118),
    vec2(78, -96),
    vec2(74, -62),
    vec2(52, -36),
    vec2(60, -6),
    vec2(84, 14),
    vec2(82, 48),
    vec2(52, 62),
    vec2(18, 56),
    vec2(2, 30)};

constexpr float kRoadHalfWidth = 4.5f;
constexpr vec2 kMiddle{42.0f, -28.0f}; ///< of the land

vec2 gateAt(int index) {
    const int count = static_cast<int>(kGates.size());
    return kGates[static_cast<size_t>(((index % count) + count) % count)];
}

/// A flat strip along the centre line. \param from, to metres to the right
Shape strip(float from, float to, float height, float tileMetres) {
    constexpr int kStepsPerGate = 14;
    Shape shape;
    const int steps = kStepsPerGate * static_cast<int>(kGates.size());
    float travelled = 0.0f;
    vec2 before = findCoursePoint(0.0f).place;
    for (int i = 0; i <= steps; ++i) {
        const float gate = static_cast<float>(i % steps) / static_cast<float>(kStepsPerGate);
        const CoursePoint point = findCoursePoint(gate);
        travelled += glm::distance(point.place, before);
        before = point.place;
        const vec2 right(-point.direction.y, point.direction.x);
        for (const float side : {from, to}) {
            const vec2 place = point.place + right * side;
            addVertex(
                shape,
                {place.x, height, place.y},
                {0, 1, 0},
                {side == from ? 0.0f : 1.0f, travelled / tileMetres}
            );
        }
        if (i == 0)
            continue;
        const size_t a = static_cast<size_t>(i - 1) * 2;
        addTriangle(shape, a, a + 1, a + 3);
        addTriangle(shape, a, a + 3, a + 2);
    }
    return shape;
}

/// A grid, since one huge triangle would lose depth to rounding.
Shape plain() {
    constexpr int kCells = 20;
    constexpr float kCellMetres = 24.0f;
    constexpr float kTileMetres = 12.0f;
    Shape shape;
    for (int z = 0; z <= kCells; ++z) {
        for (int x = 0; x <= kCells; ++x) {
            const vec2 place =
                (vec2(x, z) - static_cast<float>(kCells) / 2.0f) * kCellMetres + kMiddle;
            addVertex(shape, {place.x, 0.0f, place.y}, {0, 1, 0}, place / kTileMetres);
            if (x == 0 || z == 0)
                continue;
            const auto last = static_cast<size_t>(z * (kCells + 1) + x);
            const size_t above = last - kCells - 1;
            addTriangle(shape, last, above, above - 1);
            addTriangle(shape, last, above - 1, last - 1);
        }
    }
    return shape;
}

/// A ring of slopes that face the middle.
Shape farHills(float radius, float lowest, float highest, int seed) {
    constexpr int kColumns = 64;
    Shape shape;
    for (int i = 0; i <= kColumns; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / kColumns;
        const vec2 out(std::cos(angle), std::sin(angle));
        const float share =
            fractalNoise({static_cast<float>(i) / 8.0f, 0.5f}, {kColumns / 8, 1}, seed);
        const vec2 foot = kMiddle + out * radius;
        const vec2 top = kMiddle + out * (radius + 30.0f);
        const vec3 normal = glm::normalize(vec3(-out.x * 0.5f, 1.0f, -out.y * 0.5f));
        addVertex(shape, {foot.x, -0.5f, foot.y}, normal, {0, 0});
        addVertex(shape, {top.x, glm::mix(lowest, highest, share), top.y}, normal, {0, 1});
        if (i == 0)
            continue;
        const size_t a = static_cast<size_t>(i - 1) * 2;
        addTriangle(shape, a, a + 2, a + 3);
        addTriangle(shape, a, a + 3, a + 1);
    }
    return shape;
}

struct Wood {
    Shape trunks;
    Shape firs;
    Shape oaks; ///< crowns of trees with leaves
};

/// A round crown with bulges, about its middle.
Shape oakCrown(int seed) {
    Shape crown = sphere(1.0f, 8, 5);
    for (vec3& place : crown.positions) {
        const auto at = [&](float value) { return static_cast<int>(std::lround(8.0f * value)); };
        place *= 0.85f + 0.3f * hash(at(place.x) + 16 * at(place.y), at(place.z), seed);
    }
    smoothNormals(crown);
    return crown;
}

Wood plantTrees() {
    constexpr int kTries = 150;
    // Three skirts, each over the next.
    constexpr std::array kFir = {
        vec2(0.0f, 1.0f),
        vec2(1.75f, 1.2f),
        vec2(0.85f, 2.7f),
        vec2(1.30f, 2.6f),
        vec2(0.50f, 4.0f),
        vec2(0.85f, 3.9f),
        vec2(0.0f, 5.8f)};
    const Shape fir = withUvScale(lathe(kFir, 7), {3.0f, 3.0f});
    const std::array oaks = {oakCrown(371), oakCrown(372), oakCrown(373)};
    Wood wood;
    for (int i = 0; i < kTries; ++i) {
        const vec2 place = kMiddle + (vec2(hash(i, 0, 331), hash(i, 1, 331)) - 0.5f) * 280.0f;
        if (measureCourseDistance(place) < 14.0f)
            continue;
        const float size = 0.8f + 0.9f * hash(i, 2, 331);
        const glm::mat4 at =
            glm::scale(glm::translate(glm::mat4(1.0f), {place.x, 0.0f, place.y}), vec3(size));
        if (i % 3 != 0) {
            append(wood.firs, fir, at);
        } else {
            const glm::mat4 crown =
                glm::scale(glm::translate(at, vec3(0.0f, 3.0f, 0.0f)), vec3(2.0f, 1.7f, 2.0f));
            append(
                wood.oaks,
                withUvScale(oaks[static_cast<size_t>(i / 3) % oaks.size()], {4.0f, 3.0f}),
                glm::rotate(crown, 6.0f * hash(i, 3, 331), glm::vec3(0, 1, 0))
            );
        }
        append(wood.trunks, cylinder(0.2f, 1.6f, 5), glm::translate(at, vec3(0.0f, 0.7f, 0.0f)));
    }
    return wood;
}

} // namespace

std::span<const vec2> listCourseGates() {
    return kGates;
}

CoursePoint findCoursePoint(float gate) {
    const float whole = std::floor(gate);
    const int k = static_cast<int>(whole);
    const float t = gate - whole;
    const vec2 p0 = gateAt(k - 1);
    const vec2 p1 = gateAt(k);
    const vec2 p2 = gateAt(k + 1);
    const vec2 p3 = gateAt(k + 2);
    // Catmull and Rom 1974, tension 1/2, with its first two derivatives.
    const vec2 a = 3.0f * p1 - p0 - 3.0f * p2 + p3;
    const vec2 b = 2.0f * p0 - 5.0f * p1 + 4.0f * p2 - p3;
    const vec2 c = p2 - p0;
    const vec2 first = 0.5f * (c + t * (2.0f * b + t * 3.0f * a));
    const vec2 second = 0.5f * (2.0f * b + t * 6.0f * a);
    const float speed = glm::length(first);
    return {
        .place = 0.5f * (2.0f * p1 + t * (c + t * (b + t * a))),
        .direction = first / speed,
        .curvature = (first.x * second.y - first.y * second.x) / (speed * speed * speed)};
}

float measureCourseDistance(vec2 place) {
    constexpr int kStepsPerGate = 40;
    float nearest = std::numeric_limits<float>::infinity();
    for (int i = 0; i < kStepsPerGate * static_cast<int>(kGates.size()); ++i) {
        const float gate = static_cast<float>(i) / kStepsPerGate;
        nearest = std::min(nearest, glm::distance(place, findCoursePoint(gate).place));
    }
    return nearest;
}

void addRallyLand(GltfWriter& writer, const RallyLand& land) {
    const auto plainColor = [&](const char* name, vec3 color) {
        return writer.addMaterial({.name = name, .color = color, .roughness = 0.95f});
    };
    const Index kerb =
        addTextured(writer, "kerb", stripes({0.85f, 0.16f, 0.13f}, {0.93f, 0.92f, 0.88f}), 0.8f);
    // Along the strip, where the texture has its stripes across.
    const auto kerbStrip = [](float from, float to) {
        Shape shape = strip(from, to, 0.035f, 8.0f);
        for (vec2& uv : shape.uvs)
            uv = {uv.y, uv.x};
        return shape;
    };
    Wood wood = plantTrees();
    const Index grass = addTextured(writer, "meadow", meadow(), 0.95f);
    const Index near = plainColor("near_hills", {0.13f, 0.27f, 0.10f});
    const Index far = plainColor("far_hills", {0.20f, 0.31f, 0.34f});
    // One mesh and so one entity: the land hides nothing of itself that motion would have to
    // reveal.
    // Drawn in this order: what covers the plain comes before it, so that little is shaded twice.
    std::vector<MeshPart> parts = {
        MeshPart{.shape = land.fenceRails, .material = plainColor("rails", vec3(0.80f))},
        MeshPart{.shape = land.gatePoles, .material = plainColor("gate_poles", vec3(0.55f))},
        MeshPart{
            .shape = land.startBanner,
            .material = addTextured(writer, "start", checkers(vec3(0.95f), vec3(0.06f)), 0.8f)},
        MeshPart{
            .shape = land.banners,
            .material = addTextured(
                writer, "gate", checkers({0.95f, 0.72f, 0.12f}, {0.10f, 0.22f, 0.50f}), 0.8f
            )},
        MeshPart{
            .shape = land.arrowBoards,
            .material = addTextured(
                writer, "arrows", arrows({0.93f, 0.92f, 0.88f}, {0.85f, 0.13f, 0.10f}), 0.8f
            )},
        MeshPart{.shape = land.tyres, .material = plainColor("tyre_walls", vec3(0.045f))},
        MeshPart{.shape = land.seats, .material = plainColor("seats", {0.35f, 0.36f, 0.38f})},
        MeshPart{
            .shape = land.awning,
            .material = addTextured(
                writer, "awning", stripes({0.16f, 0.32f, 0.62f}, {0.94f, 0.92f, 0.86f}), 0.8f
            )},
        MeshPart{
            .shape = land.fencePosts, .material = plainColor("fence_posts", {0.26f, 0.17f, 0.10f})},
        MeshPart{
            .shape = strip(-kRoadHalfWidth, kRoadHalfWidth, 0.02f, 8.0f),
            .material = addTextured(writer, "roadway", roadway(), 0.9f)},
        MeshPart{.shape = kerbStrip(-kRoadHalfWidth - 0.45f, -kRoadHalfWidth), .material = kerb},
        MeshPart{.shape = kerbStrip(kRoadHalfWidth, kRoadHalfWidth + 0.45f), .material = kerb},
        MeshPart{.shape = wood.trunks, .material = plainColor("trunks", {0.16f, 0.10f, 0.06f})},
        MeshPart{
            .shape = wood.firs,
            .material = addTextured(writer, "firs", leaves({0.22f, 0.40f, 0.22f}), 0.95f)},
        MeshPart{
            .shape = wood.oaks,
            .material = addTextured(writer, "oaks", leaves({0.36f, 0.55f, 0.22f}), 0.95f)},
        MeshPart{.shape = farHills(150.0f, 5.0f, 16.0f, 341), .material = near},
        MeshPart{.shape = plain(), .material = grass},
        MeshPart{.shape = farHills(190.0f, 14.0f, 34.0f, 342), .material = far},
    };
    constexpr std::array kClothes = {
        vec3(0.70f, 0.12f, 0.08f),
        vec3(0.80f, 0.62f, 0.10f),
        vec3(0.12f, 0.24f, 0.55f),
        vec3(0.75f, 0.72f, 0.66f)};
    for (size_t i = 0; i < land.spectators.size(); ++i)
        parts.push_back(
            {.shape = land.spectators[i],
             .material =
                 writer.addMaterial({.name = "clothes", .color = kClothes[i % kClothes.size()]})}
        );
    writer.addNode({.name = "land", .mesh = writer.addMesh("land", parts)});
}

} // namespace shutter::generator
