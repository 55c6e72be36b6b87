// SPDX-License-Identifier: MIT
// The car of the rally and what stands along its way.
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

/// What turns and what only looks so: a plain tyre is the same however far it has rolled, so that
/// it need not move at all.
struct WheelMeshes {
    Index tyre = kNothing;
    Index spokes = kNothing;
};

WheelMeshes addWheelMeshes(GltfWriter& writer) {
    constexpr float kRadius = 0.34f;
    constexpr float kTyre = 0.055f;
    constexpr int kSpokes = 10;
    const mat4 axisToZ = glm::rotate(mat4(1.0f), glm::half_pi<float>(), kX);
    Shape tyre;
    append(tyre, torus(kRadius - kTyre, kTyre, 28, 8), glm::scale(axisToZ, vec3(1.0f, 1.9f, 1.0f)));
    Shape spokes;
    append(spokes, cylinder(0.06f, 0.17f, 10), axisToZ);
    for (int i = 0; i < kSpokes; ++i) {
        const mat4 turn = glm::rotate(
            mat4(1.0f), glm::two_pi<float>() * static_cast<float>(i) / kSpokes, {0, 0, 1}
        );
        append(
            spokes,
            box({0.014f, 0.125f, 0.018f}, 1.0f),
            glm::translate(turn, vec3(0.0f, 0.155f, i % 2 == 0 ? 0.05f : -0.05f))
        );
    }
    const MeshPart tyrePart{
        .shape = tyre, .material = addPlainMaterial(writer, "tyre", vec3(0.04f), 0.9f)};
    const MeshPart spokesPart{
        .shape = spokes, .material = addPlainMaterial(writer, "spokes", vec3(0.72f), 0.35f)};
    return {writer.addMesh("tyre", {&tyrePart, 1}), writer.addMesh("spokes", {&spokesPart, 1})};
}

Index addBodyMesh(GltfWriter& writer) {
    Shape paint = roundedBox({0.60f, 0.20f, 1.90f}, 0.10f, 2, 1.0f);
    append(paint, roundedBox({0.46f, 0.06f, 0.62f}, 0.05f, 2, 1.0f), moved({0, 0.66f, 0.30f}));
    append(paint, box({0.70f, 0.02f, 0.16f}, 1.0f), moved({0, 0.50f, 1.72f}));
    for (const float side : {-1.0f, 1.0f})
        append(paint, box({0.03f, 0.14f, 0.10f}, 1.0f), moved({side * 0.45f, 0.34f, 1.72f}));
    const Shape glass = roundedBox({0.50f, 0.24f, 0.86f}, 0.12f, 2, 1.0f);
    for (const float z : {-1.22f, 1.22f})
        append(paint, box({0.80f, 0.03f, 0.05f}, 1.0f), moved({0.0f, -0.12f, z}));
    Shape cabin;
    append(cabin, glass, moved({0, 0.40f, 0.28f}));
    Shape stripe = box({0.16f, 0.012f, 1.80f}, 1.0f);
    Shape stripes;
    append(stripes, stripe, moved({0, 0.195f, 0.0f}));
    append(stripes, box({0.16f, 0.01f, 0.50f}, 1.0f), moved({0, 0.718f, 0.30f}));
    Shape lamps;
    Shape tails;
    for (const float side : {-1.0f, 1.0f}) {
        append(lamps, box({0.14f, 0.06f, 0.03f}, 1.0f), moved({side * 0.42f, 0.05f, -1.89f}));
        append(tails, box({0.14f, 0.05f, 0.03f}, 1.0f), moved({side * 0.42f, 0.06f, 1.89f}));
    }
    const std::array parts = {
        MeshPart{
            .shape = paint,
            .material = addPlainMaterial(writer, "paint", {0.62f, 0.05f, 0.05f}, 0.35f)},
        MeshPart{
            .shape = cabin,
            .material = addPlainMaterial(writer, "glass", {0.03f, 0.05f, 0.07f}, 0.15f)},
        MeshPart{
            .shape = stripes, .material = addPlainMaterial(writer, "stripe", vec3(0.85f), 0.4f)},
        MeshPart{
            .shape = lamps,
            .material = writer.addMaterial({.name = "lamps", .emissive = {0.9f, 0.85f, 0.6f}})},
        MeshPart{
            .shape = tails,
            .material = writer.addMaterial(
                {.name = "tails", .color = {0.3f, 0.0f, 0.0f}, .emissive = {0.8f, 0.04f, 0.03f}}
            )}};
    return writer.addMesh("car_body", parts);
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
        // Its front, the rails' side, looks at the road.
        const vec2 front = right * -side;
        const vec3 foot(place.x, 0.0f, place.y);
        const glm::quat turn = glm::angleAxis(std::atan2(front.x, front.y), kY);
        addFencePanel(land, moved(foot) * glm::mat4_cast(turn));
        writer.addNode(
            {.name = fmt::format("fence_{:02}", fences++), .translation = foot, .rotation = turn}
        );
    };
    const auto addPost = [&](const CoursePoint& point, float side) {
        const vec2 place = point.place + vec2(-point.direction.y, point.direction.x) * side;
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
        // Measured where the fence stands: on the outer side the way is longer.
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

} // namespace

void addRallyCar(GltfWriter& writer) {
    const Index car = writer.addNode({.name = "car"});
    // What would be its shadow.
    const Index shade = writer.addMaterial({.name = "shade", .color = vec3(0.015f)});
    addObject(
        writer,
        {.name = "car_shade", .parent = car, .translation = {0.0f, 0.06f, 0.0f}},
        box({0.80f, 0.01f, 1.80f}, 1.0f),
        shade
    );
    const Index body = writer.addNode(
        {.name = "car_body",
         .parent = car,
         .translation = {0.0f, 0.46f, 0.0f},
         .mesh = addBodyMesh(writer)}
    );
    writer.addNode(
        {.name = "bonnet",
         .parent = body,
         .translation = {0.0f, 0.60f, -0.66f},
         .rotation = glm::angleAxis(-0.06f, kX),
         .camera = writer.addCamera("bonnet", 1.0f, 0.1f)}
    );
    const WheelMeshes meshes = addWheelMeshes(writer);
    for (const bool front : {true, false}) {
        for (const bool left : {true, false}) {
            const std::string place =
                fmt::format("{}_{}", front ? "front" : "rear", left ? "left" : "right");
            const Index wheel = writer.addNode(
                {.name = "wheel_" + place,
                 .parent = car,
                 .translation = {left ? -0.84f : 0.84f, 0.34f, front ? -1.22f : 1.22f},
                 .rotation = glm::angleAxis(glm::half_pi<float>(), kY),
                 .mesh = meshes.tyre}
            );
            writer.addNode({.name = "spokes_" + place, .parent = wheel, .mesh = meshes.spokes});
        }
    }
}

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
    addRallyLand(writer, land);
    addRallyCar(writer);
    return writer;
}

} // namespace shutter::generator
