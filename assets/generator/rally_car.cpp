// SPDX-License-Identifier: MIT
// The car of the rally.
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
#include <vector>

namespace shutter::generator {

namespace {

/// Meshes that turn, and ones that need not: a plain tyre looks the same at any rotation.
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

// The body's frame: the middle of the car, 0.46 m above the ground; -Z is ahead.

/// The hull between the wheels, from nose to tail.
constexpr std::array kHull = {
    LoftSection{-1.96f, 0.42f, -0.17f, 0.00f},
    LoftSection{-1.84f, 0.58f, -0.23f, 0.10f},
    LoftSection{-1.40f, 0.64f, -0.24f, 0.19f},
    LoftSection{-0.62f, 0.66f, -0.24f, 0.27f},
    LoftSection{0.30f, 0.68f, -0.24f, 0.29f},
    LoftSection{1.20f, 0.67f, -0.24f, 0.30f},
    LoftSection{1.72f, 0.62f, -0.22f, 0.28f},
    LoftSection{1.90f, 0.54f, -0.17f, 0.20f}};

constexpr std::array kCabin = {
    LoftSection{-0.74f, 0.56f, 0.18f, 0.24f},
    LoftSection{-0.20f, 0.53f, 0.18f, 0.63f},
    LoftSection{0.05f, 0.52f, 0.18f, 0.67f},
    LoftSection{0.72f, 0.51f, 0.18f, 0.67f},
    LoftSection{0.95f, 0.51f, 0.18f, 0.61f},
    LoftSection{1.36f, 0.53f, 0.18f, 0.31f}};

/// A strip of paint along the top of a loft's sections, a little above it.
Shape stripeAlong(std::span<const LoftSection> sections, float halfWidth) {
    std::vector<LoftSection> strip;
    for (const LoftSection& section : sections)
        strip.push_back({section.z, halfWidth, section.top - 0.03f, section.top + 0.006f});
    return loft(strip, 0.3f);
}

/// Over the top of a wheel whose axle is at `axle`: what turns stays in sight.
Shape mudguard(vec3 axle) {
    constexpr int kSteps = 10;
    std::array<vec3, kSteps + 1> arc;
    for (int i = 0; i <= kSteps; ++i) {
        const float angle = glm::pi<float>() * (0.20f + 0.62f * static_cast<float>(i) / kSteps);
        arc[static_cast<size_t>(i)] = {0.0f, 0.40f * std::sin(angle), -0.42f * std::cos(angle)};
    }
    Shape shape;
    append(shape, tube(arc, 0.035f, 8), glm::scale(moved(axle), vec3(3.6f, 1.0f, 1.0f)));
    return shape;
}

/// What has the colour of the car.
Shape buildPaint() {
    Shape paint = loft(kHull, 0.55f);
    for (const float z : {-1.22f, 1.22f})
        for (const float x : {-0.80f, 0.80f})
            append(paint, mudguard({x, -0.12f, z}));
    append(paint, roundedBox({0.49f, 0.025f, 0.44f}, 0.02f, 1, 1.0f), moved({0, 0.68f, 0.38f}));
    for (const float side : {-1.0f, 1.0f}) {
        const std::array front = {
            vec3(side * 0.55f, 0.24f, -0.70f), vec3(side * 0.50f, 0.66f, -0.08f)};
        const std::array middle = {
            vec3(side * 0.54f, 0.24f, 0.42f), vec3(side * 0.51f, 0.66f, 0.40f)};
        const std::array rear = {
            vec3(side * 0.50f, 0.66f, 0.80f), vec3(side * 0.53f, 0.28f, 1.34f)};
        for (const auto& pillar : {front, middle, rear})
            append(paint, tube(pillar, 0.032f, 6));
        // Mirrors, and what carries the spoiler.
        append(
            paint,
            roundedBox({0.05f, 0.04f, 0.03f}, 0.015f, 1, 1.0f),
            moved({side * 0.66f, 0.36f, -0.42f})
        );
        append(paint, box({0.02f, 0.14f, 0.09f}, 1.0f), moved({side * 0.44f, 0.40f, 1.66f}));
        append(paint, box({0.012f, 0.07f, 0.16f}, 1.0f), moved({side * 0.70f, 0.54f, 1.70f}));
    }
    append(paint, roundedBox({0.70f, 0.018f, 0.15f}, 0.012f, 1, 1.0f), moved({0, 0.54f, 1.70f}));
    append(paint, roundedBox({0.20f, 0.035f, 0.16f}, 0.03f, 1, 1.0f), moved({0, 0.25f, -0.98f}));
    return paint;
}

/// Axles, bumpers and exhaust.
Shape buildChassis() {
    Shape chassis;
    const mat4 alongZ = glm::rotate(mat4(1.0f), glm::half_pi<float>(), kX);
    for (const float z : {-1.22f, 1.22f})
        append(chassis, box({0.78f, 0.03f, 0.05f}, 1.0f), moved({0.0f, -0.12f, z}));
    append(chassis, roundedBox({0.52f, 0.05f, 0.05f}, 0.03f, 1, 1.0f), moved({0, -0.12f, -1.96f}));
    append(chassis, roundedBox({0.58f, 0.05f, 0.05f}, 0.03f, 1, 1.0f), moved({0, -0.10f, 1.93f}));
    append(chassis, cylinder(0.04f, 0.24f, 10), moved({0.34f, -0.22f, 1.92f}) * alongZ);
    // The grille.
    append(chassis, box({0.34f, 0.06f, 0.01f}, 1.0f), moved({0, -0.05f, -1.955f}));
    return chassis;
}

Index addBodyMesh(GltfWriter& writer) {
    const mat4 alongZ = glm::rotate(mat4(1.0f), glm::half_pi<float>(), kX);
    const mat4 alongX = glm::rotate(mat4(1.0f), glm::half_pi<float>(), kZ);
    const std::span<const LoftSection> hull(kHull);
    Shape stripes = stripeAlong(hull.first(4), 0.15f);
    append(stripes, stripeAlong(hull.subspan(5, 2), 0.15f));
    append(stripes, box({0.15f, 0.006f, 0.42f}, 1.0f), moved({0, 0.705f, 0.38f}));
    Shape lamps;
    Shape tails;
    for (const float side : {-1.0f, 1.0f}) {
        append(stripes, cylinder(0.19f, 0.02f, 20), moved({side * 0.675f, 0.03f, 0.36f}) * alongX);
        append(lamps, cylinder(0.085f, 0.06f, 14), moved({side * 0.42f, 0.00f, -1.93f}) * alongZ);
        append(lamps, cylinder(0.07f, 0.05f, 14), moved({side * 0.17f, 0.10f, -1.93f}) * alongZ);
        append(
            tails,
            roundedBox({0.12f, 0.05f, 0.02f}, 0.015f, 1, 1.0f),
            moved({side * 0.38f, 0.09f, 1.90f})
        );
    }
    const std::array parts = {
        MeshPart{
            .shape = buildPaint(),
            .material = addPlainMaterial(writer, "paint", {0.62f, 0.05f, 0.05f}, 0.3f)},
        MeshPart{
            .shape = loft(kCabin, 0.35f),
            .material = addPlainMaterial(writer, "glass", {0.03f, 0.05f, 0.07f}, 0.12f)},
        MeshPart{
            .shape = stripes, .material = addPlainMaterial(writer, "stripe", vec3(0.85f), 0.4f)},
        MeshPart{
            .shape = buildChassis(),
            .material = addPlainMaterial(writer, "chassis", vec3(0.03f), 0.6f)},
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

} // namespace

void addRallyCar(GltfWriter& writer) {
    const Index car = writer.addNode({.name = "car"});
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

} // namespace shutter::generator
