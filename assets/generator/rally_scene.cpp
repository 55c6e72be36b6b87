// SPDX-License-Identifier: MIT
// Objects along the rally's road.
#include "assets/generator/axes.h"
#include "assets/generator/demo_scenes.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/scenes.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <string>

namespace shutter::generator {

namespace {

/// Turned so that -Z points along `direction` of the ground.
glm::quat headingOf(vec2 direction) {
    return glm::angleAxis(std::atan2(-direction.x, -direction.y), kY);
}

/// Drawn with the land, as the fences are.
void addGates(GltfWriter& writer, RallyLand& land) {
    constexpr float kHalfWidth = 5.9f;
    for (size_t i = 0; i < listCourseGates().size(); ++i) {
        const CoursePoint point = findCoursePoint(static_cast<float>(i));
        const vec3 foot(point.place.x, 0.0f, point.place.y);
        const glm::quat turn = headingOf(point.direction);
        writer.addNode({.name = fmt::format("gate_{:02}", i), .translation = foot, .rotation = turn}
        );
        const mat4 at = moved(foot) * glm::mat4_cast(turn);
        for (const float side : {-1.0f, 1.0f})
            append(
                land.gatePoles,
                cylinder(0.10f, 4.6f, 8),
                glm::translate(at, vec3(side * kHalfWidth, 2.3f, 0.0f))
            );
        append(
            i == 0 ? land.startBanner : land.banners,
            box({kHalfWidth, 0.34f, 0.03f}, 0.68f),
            glm::translate(at, vec3(0.0f, 4.26f, 0.0f))
        );
    }
}

/// A board on a fence panel that shows drivers the way of the bend. \param side the fence's, +1
/// right
void addArrowBoard(RallyLand& land, const mat4& at, float side) {
    Shape board = box({1.1f, 0.28f, 0.02f}, 1.0f);
    for (size_t i = 0; i < board.uvs.size(); ++i) {
        const vec3 place = board.positions[i];
        // Along the fence's X the road goes one way on its right side, the other way on its left.
        board.uvs[i] = {0.5f - side * place.x / 2.2f, 0.5f - place.y / 0.56f};
    }
    append(land.arrowBoards, board, glm::translate(at, vec3(0.0f, 1.30f, 0.0f)));
}

/// Three tyres on each other.
void addTyreStack(RallyLand& land, vec3 foot) {
    const Shape tyre = torus(0.30f, 0.12f, 9, 5);
    for (int i = 0; i < 3; ++i)
        append(land.tyres, tyre, moved(foot + kY * (0.12f + 0.24f * static_cast<float>(i))));
}

/// Rows of seats with people on them, along the straight.
void addGrandstand(RallyLand& land) {
    constexpr int kRows = 5;
    constexpr int kColours = 4;
    constexpr float kHalfLength = 11.0f;
    const vec3 foot(-9.2f, 0.0f, -22.0f); // of its front, next to the road
    land.spectators.resize(kColours);
    Shape person = cylinder(0.17f, 0.52f, 6);
    append(person, sphere(0.12f, 6, 4), moved({0.0f, 0.38f, 0.0f}));
    for (int row = 0; row < kRows; ++row) {
        const float height = 0.35f + 0.42f * static_cast<float>(row);
        const vec3 middle = foot + vec3(-0.75f * static_cast<float>(row), height / 2.0f, 0.0f);
        append(land.seats, box({0.375f, height / 2.0f, kHalfLength}, 1.0f), moved(middle));
        for (int seat = 0; seat < 26; ++seat) {
            if (hash(seat, row, 361) < 0.35f)
                continue;
            const auto colour = static_cast<size_t>(kColours * hash(seat, row, 362));
            const float z =
                (static_cast<float>(seat) - 12.5f) * 0.82f + 0.2f * hash(seat, row, 363);
            append(
                land.spectators[colour],
                person,
                moved(middle + vec3(0.0f, height / 2.0f + 0.26f, z))
            );
        }
    }
    append(
        land.awning,
        box({2.3f, 0.05f, kHalfLength + 0.4f}, 3.0f),
        glm::rotate(moved(foot + vec3(-1.7f, 4.3f, 0.0f)), 0.12f, kZ)
    );
    for (const float z : {-1.0f, -0.33f, 0.33f, 1.0f})
        append(
            land.gatePoles,
            cylinder(0.07f, 4.0f, 8),
            moved(foot + vec3(-3.6f, 2.0f, z * kHalfLength))
        );
}

/// A panel of 4 m with two rails, along its X, into the land's parts: an entity each would make
/// every edge of them one that motion could reveal something behind.
void addFencePanel(RallyLand& land, const mat4& at) {
    for (const float height : {0.42f, 0.82f})
        append(
            land.fenceRails,
            box({2.02f, 0.08f, 0.025f}, 1.0f),
            glm::translate(at, vec3(0.0f, height, 0.0f))
        );
    for (const float x : {-1.9f, 0.0f, 1.9f})
        append(
            land.fencePosts,
            box({0.05f, 0.50f, 0.05f}, 1.0f),
            glm::translate(at, vec3(x, 0.5f, -0.05f))
        );
}

/// Fences on the outer side of every bend and along the start; posts on the inner side and, for a
/// slalom, on the straight.
void addPostsAndFences(GltfWriter& writer, RallyLand& land) {
    constexpr float kFenceDistance = 7.6f;
    constexpr float kPostDistance = 5.4f;
    constexpr float kPostEvery = 8.0f;
    constexpr float kFenceEvery = 4.0f;
    const MeshPart postPart{
        .shape = withUvScale(cylinder(0.07f, 1.1f, 8), {1.0f, 1.0f}),
        .material = addTextured(
            writer, "post", stripes({0.93f, 0.91f, 0.86f}, {0.90f, 0.32f, 0.06f}), 0.6f
        )};
    const Index post = writer.addMesh("post", {&postPart, 1});
    int fences = 0;
    int posts = 0;
    const auto addFence = [&](const CoursePoint& point, float side) {
        const vec2 right(-point.direction.y, point.direction.x);
        const vec2 place = point.place + right * (side * kFenceDistance);
        // Its front, the rails' side, faces the road.
        const vec2 front = right * -side;
        const vec3 foot(place.x, 0.0f, place.y);
        const glm::quat turn = glm::angleAxis(std::atan2(front.x, front.y), kY);
        const mat4 at = moved(foot) * glm::mat4_cast(turn);
        addFencePanel(land, at);
        if (std::abs(point.curvature) > 0.03f && fences % 2 == 0)
            addArrowBoard(land, at, side);
        writer.addNode(
            {.name = fmt::format("fence_{:02}", fences++), .translation = foot, .rotation = turn}
        );
    };
    const auto addPost = [&](const CoursePoint& point, float side) {
        const vec2 right(-point.direction.y, point.direction.x);
        const vec2 place = point.place + right * side;
        // Out of the way, what cushions who cuts the bend.
        if (std::abs(side) > kPostDistance - 0.1f && posts % 2 == 0) {
            const vec2 behind = place + right * std::copysign(2.2f, side);
            addTyreStack(land, {behind.x, 0.0f, behind.y});
        }
        writer.addNode(
            {.name = fmt::format("post_{:02}", posts++),
             .translation = {place.x, 0.55f, place.y},
             .mesh = post}
        );
    };
    float sinceFence = kFenceEvery;
    float sincePost = kPostEvery;
    constexpr int kStepsPerGate = 200;
    vec2 before = findCoursePoint(0.0f).place;
    for (int i = 0; i < kStepsPerGate * static_cast<int>(listCourseGates().size()); ++i) {
        const CoursePoint point = findCoursePoint(static_cast<float>(i) / kStepsPerGate);
        const float outer = point.curvature > 0.0f ? -1.0f : 1.0f;
        // Measured at the fence: on the outer side the curve is longer.
        const float stretch = 1.0f + std::abs(point.curvature) * kFenceDistance;
        sinceFence += glm::distance(point.place, before) * stretch;
        sincePost += glm::distance(point.place, before);
        before = point.place;
        const bool bends = std::abs(point.curvature) > 0.016f;
        if (bends && sinceFence >= kFenceEvery) {
            addFence(point, outer);
            sinceFence = 0.0f;
        }
        if (bends && sincePost >= kPostEvery) {
            addPost(point, -outer * kPostDistance);
            sincePost = 0.0f;
        }
    }
    // In the way on the straight: two to pass on one side, the next two on the other.
    for (const vec2 turn : {vec2(0.45f, 0.6f), {0.80f, -0.6f}, {1.20f, 0.6f}, {1.60f, -0.6f}})
        for (const float farther : {1.0f, 1.7f})
            addPost(findCoursePoint(turn.x), turn.y * farther);
}

/// Poles with flags behind the grandstand, and tufts of grass before it, which one wind of the
/// world moves.
void addWind(GltfWriter& writer, RallyLand& land) {
    constexpr vec2 kFlagHalf{0.75f, 0.45f};
    const MeshPart flag{
        .shape = cloth(kFlagHalf, {12, 6}, 0.6f),
        .material = writer.addMaterial(
            {.name = "flag",
             .texture =
                 writer.addTexture("flag", checkers({0.90f, 0.16f, 0.12f}, {0.94f, 0.90f, 0.80f})),
             .roughness = 0.9f,
             .doubleSided = true}
        )};
    const Index mesh = writer.addMesh("flag", {&flag, 1});
    for (int i = 0; i < 4; ++i) {
        const vec3 foot(-12.9f, 0.0f, -31.0f + 6.0f * static_cast<float>(i));
        append(land.gatePoles, cylinder(0.05f, 6.4f, 8), moved(foot + kY * 3.2f));
        writer.addNode(
            {.name = fmt::format("flag_{}", i),
             .translation = foot + vec3(kFlagHalf.x + 0.05f, 5.9f, 0.0f),
             .mesh = mesh,
             .waves =
                 {{"space", "world"},
                  {"share", "color"},
                  {"waves",
                   {{{"displacement", {0.0f, 0.05f, 0.22f}},
                     {"waveVector", {5.0f, 1.0f, 0.3f}},
                     {"hertz", 2.1f}},
                    {{"displacement", {0.0f, 0.07f, 0.06f}},
                     {"waveVector", {9.0f, -2.0f, 0.7f}},
                     {"hertz", 3.7f}}}}}}
        );
    }
    Shape tufts;
    for (int i = 0; i < 180; ++i) {
        constexpr vec2 kBladeHalf{0.20f, 0.016f}; // along, across
        Shape blade = cloth(kBladeHalf, {3, 1}, 1.0f);
        for (size_t vertex = 0; vertex < blade.positions.size(); ++vertex)
            blade.positions[vertex].y *= 1.0f - blade.slack[vertex];
        const int tuft = i / 6;
        const vec3 foot(
            -6.9f + 0.9f * hash(tuft, 0, 371) + 0.12f * hash(i, 1, 371),
            kBladeHalf.x,
            -32.0f + 0.7f * static_cast<float>(tuft) + 0.12f * hash(i, 2, 371)
        );
        const mat4 turn = glm::rotate(moved(foot), glm::two_pi<float>() * hash(i, 3, 371), kY);
        append(
            tufts, blade, glm::rotate(turn, glm::half_pi<float>() - 0.35f * hash(i, 4, 371), kZ)
        );
    }
    const MeshPart grass{
        .shape = tufts,
        .material = writer.addMaterial(
            {.name = "grass",
             .color = {0.24f, 0.50f, 0.10f},
             .roughness = 0.9f,
             .doubleSided = true}
        )};
    writer.addNode(
        {.name = "grass",
         .mesh = writer.addMesh("grass", {&grass, 1}),
         .waves =
             {{"space", "world"},
              {"share", "color"},
              {"exponent", 1.5f},
              {"lean", {0.03f, 0.0f, 0.02f}},
              {"waves",
               {{{"displacement", {0.09f, -0.02f, 0.05f}},
                 {"waveVector", {0.9f, 0.0f, 0.6f}},
                 {"hertz", 1.3f}},
                {{"displacement", {0.03f, 0.0f, 0.03f}},
                 {"waveVector", {4.0f, 0.0f, 5.0f}},
                 {"hertz", 3.9f}}}}}}
    );
}

} // namespace

GltfWriter buildRallyScene() {
    GltfWriter writer("rally");
    writer.addNode(
        {.name = "chase",
         .translation = {0.0f, 1.5f, 5.0f},
         .camera = writer.addCamera("chase", 0.86f, 0.1f)}
    );
    addDemoSun(writer, {0.45f, -0.80f, -0.55f});
    RallyLand land;
    addGates(writer, land);
    addPostsAndFences(writer, land);
    addGrandstand(land);
    addWind(writer, land);
    addRallyLand(writer, land);
    addRallyCar(writer);
    return writer;
}

} // namespace shutter::generator
