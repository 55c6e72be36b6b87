// SPDX-License-Identifier: MIT
// A fairground of things that turn: a carousel, a fan that it drives, and a wind wheel.
#include "assets/generator/axes.h"
#include "assets/generator/demo_scenes.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/props.h"
#include "assets/generator/scenes.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <initializer_list>

namespace shutter::generator {

namespace {

constexpr int kSeatCount = 8;
constexpr float kSeatRadius = 2.3f;

/// A hobby horse facing +X, about the middle of its trunk, with its pole.
struct Horse {
    Shape coat;
    Shape tack; ///< saddle and pole
};

Horse buildHorse() {
    Horse horse;
    const auto limb =
        [&](Shape& shape, std::initializer_list<vec3> path, std::initializer_list<float> radii) {
            append(shape, tube({path.begin(), path.size()}, {radii.begin(), radii.size()}, 8));
        };
    // Trunk, neck and head.
    limb(
        horse.coat,
        {{-0.42f, 0.02f, 0},
         {-0.32f, 0.03f, 0},
         {0.0f, -0.02f, 0},
         {0.28f, 0.02f, 0},
         {0.38f, 0.04f, 0}},
        {0.08f, 0.16f, 0.15f, 0.16f, 0.09f}
    );
    limb(
        horse.coat,
        {{0.26f, 0.04f, 0}, {0.40f, 0.26f, 0}, {0.50f, 0.45f, 0}, {0.53f, 0.50f, 0}},
        {0.14f, 0.10f, 0.075f, 0.03f}
    );
    limb(
        horse.coat,
        {{0.44f, 0.47f, 0}, {0.52f, 0.46f, 0}, {0.66f, 0.35f, 0}, {0.72f, 0.31f, 0}},
        {0.05f, 0.075f, 0.055f, 0.035f}
    );
    for (const float z : {-0.08f, 0.08f}) {
        // Ears; the front legs lifted, the hind ones stretched.
        limb(horse.coat, {{0.49f, 0.50f, 0.5f * z}, {0.47f, 0.60f, 0.6f * z}}, {0.025f, 0.005f});
        limb(
            horse.coat,
            {{0.28f, -0.06f, z}, {0.46f, -0.20f, z}, {0.40f, -0.38f, z}, {0.43f, -0.42f, z}},
            {0.07f, 0.045f, 0.03f, 0.04f}
        );
        limb(
            horse.coat,
            {{-0.32f, -0.04f, z}, {-0.38f, -0.24f, z}, {-0.52f, -0.40f, z}, {-0.51f, -0.45f, z}},
            {0.09f, 0.05f, 0.03f, 0.04f}
        );
    }
    // Tail, mane, saddle and pole.
    limb(
        horse.tack,
        {{-0.42f, 0.06f, 0}, {-0.54f, 0.04f, 0}, {-0.60f, -0.14f, 0}, {-0.58f, -0.28f, 0}},
        {0.02f, 0.045f, 0.05f, 0.005f}
    );
    limb(
        horse.tack,
        {{0.24f, 0.20f, 0}, {0.34f, 0.36f, 0}, {0.43f, 0.52f, 0}, {0.50f, 0.56f, 0}},
        {0.01f, 0.035f, 0.035f, 0.01f}
    );
    append(horse.tack, roundedBox({0.15f, 0.04f, 0.17f}, 0.03f, 1, 1.0f), moved({0, 0.12f, 0}));
    append(horse.tack, cylinder(0.022f, 2.3f, 8), moved({0.0f, 0.35f, 0.0f}));
    return horse;
}

void addSeats(GltfWriter& writer, Index carousel) {
    const Horse horse = buildHorse();
    const Index tack = addPlainMaterial(writer, "tack", {0.60f, 0.45f, 0.16f}, 0.4f);
    const auto addHorseMesh = [&](const char* name, vec3 color) {
        const std::array parts = {
            MeshPart{.shape = horse.coat, .material = addPlainMaterial(writer, name, color, 0.5f)},
            MeshPart{.shape = horse.tack, .material = tack}};
        return writer.addMesh(name, parts);
    };
    const std::array meshes = {
        addHorseMesh("horse_gold", {0.85f, 0.55f, 0.08f}),
        addHorseMesh("horse_white", vec3(0.80f)),
        addHorseMesh("horse_red", {0.60f, 0.10f, 0.08f})};
    for (int i = 0; i < kSeatCount; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / kSeatCount;
        const glm::quat turn = glm::angleAxis(angle, kY);
        // Seat 0 faces +Z of the carousel; the horses run the way it turns, counter-clockwise.
        writer.addNode(
            {.name = fmt::format("seat_{}", i),
             .parent = carousel,
             .translation = turn * vec3(0.0f, 1.05f, kSeatRadius),
             .rotation = turn,
             .mesh = meshes[i == 0 ? 0 : (i % 2 == 0 ? 2 : 1)]}
        );
    }
}

/// Along the roof's rim and its ribs, and one on top.
Shape buildRoofLamps() {
    Shape lamps;
    constexpr int kRimLamps = 40;
    for (int i = 0; i < kRimLamps; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / kRimLamps;
        const vec3 out(std::cos(angle), 0.0f, std::sin(angle));
        append(lamps, sphere(0.05f, 7, 5), moved(out * 3.28f + kY * 2.48f));
        if (i % 5 == 0)
            for (const float share : {0.25f, 0.5f, 0.75f})
                append(
                    lamps,
                    sphere(0.05f, 7, 5),
                    moved(out * glm::mix(3.2f, 1.6f, share) + kY * glm::mix(2.82f, 3.30f, share))
                );
    }
    append(lamps, sphere(0.16f, 12, 8), moved({0.0f, 4.2f, 0.0f}));
    return lamps;
}

Index addCarousel(GltfWriter& writer) {
    constexpr std::array kPlatform = {vec2(0.0f, 0.45f), vec2(3.0f, 0.45f)};
    constexpr std::array kRim = {vec2(3.0f, 0.15f), vec2(3.0f, 0.45f)};
    constexpr std::array kRoof = {vec2(3.25f, 2.75f), vec2(1.6f, 3.25f), vec2(0.0f, 4.1f)};
    constexpr std::array kCeiling = {vec2(0.0f, 2.75f), vec2(3.25f, 2.75f)};
    // A run that goes outwards faces down; the deck is its mirror image, from the rim inwards.
    constexpr std::array kDeck = {kPlatform[1], kPlatform[0]};
    constexpr std::array kValance = {vec2(3.25f, 2.5f), vec2(3.25f, 2.75f)};
    const Index canvas =
        addTextured(writer, "canvas", stripes({0.84f, 0.16f, 0.14f}, {0.95f, 0.92f, 0.84f}), 0.8f);
    const Index bunting = addTextured(
        writer, "bunting", checkers({0.95f, 0.76f, 0.18f}, {0.14f, 0.24f, 0.56f}), 0.8f
    );
    const std::array parts = {
        MeshPart{
            .shape = withUvScale(lathe(kDeck, 32), {8.0f, 1.0f}),
            .material = addTextured(
                writer, "deck", stripes({0.46f, 0.28f, 0.16f}, {0.58f, 0.38f, 0.22f}), 0.8f
            )},
        MeshPart{.shape = withUvScale(lathe(kRim, 32), {12.0f, 1.0f}), .material = bunting},
        MeshPart{.shape = withUvScale(lathe(kRoof, 32), {3.0f, 1.0f}), .material = canvas},
        MeshPart{
            .shape = lathe(kCeiling, 32),
            .material = addPlainMaterial(writer, "ceiling", {0.42f, 0.33f, 0.24f}, 0.9f)},
        MeshPart{.shape = withUvScale(lathe(kValance, 32), {16.0f, 1.0f}), .material = bunting},
        MeshPart{
            .shape = buildRoofLamps(),
            .material = writer.addMaterial({.name = "bulbs", .emissive = {1.0f, 0.85f, 0.5f}})}};
    const Index carousel = writer.addNode(
        {.name = "carousel",
         .translation = {-1.6f, 0.0f, -1.0f},
         .mesh = writer.addMesh("carousel", parts)}
    );
    addObject(
        writer,
        {.name = "hub", .parent = carousel, .translation = {0.0f, 1.6f, 0.0f}},
        withUvScale(cylinder(0.55f, 2.3f, 24), {3.0f, 1.0f}),
        addTextured(writer, "hub", stripes({0.12f, 0.34f, 0.40f}, {0.92f, 0.86f, 0.66f}), 0.5f)
    );
    addSeats(writer, carousel);
    // On the outermost horses' way: what a rider sees.
    writer.addNode(
        {.name = "rider",
         .parent = carousel,
         .translation = glm::angleAxis(-0.42f, kY) * vec3(0.0f, 2.05f, 2.35f),
         .rotation = glm::angleAxis(-1.15f, kY),
         .camera = writer.addCamera("rider", 0.95f, 0.1f)}
    );
    return carousel;
}

void addFan(GltfWriter& writer) {
    const Index iron = addPlainMaterial(writer, "iron", {0.20f, 0.22f, 0.25f}, 0.5f);
    Shape tower;
    append(tower, roundedBox({0.16f, 1.35f, 0.16f}, 0.03f, 1, 1.0f), moved({0, 1.35f, -0.30f}));
    append(tower, roundedBox({0.50f, 0.10f, 0.45f}, 0.04f, 1, 1.0f), moved({0, 0.10f, -0.20f}));
    append(
        tower,
        torus(1.32f, 0.045f, 40, 8),
        glm::rotate(moved({0.0f, 2.5f, 0.0f}), glm::half_pi<float>(), kX)
    );
    addObject(writer, {.name = "fan_tower", .translation = {3.6f, 0.0f, -0.2f}}, tower, iron);
    const std::array parts = {MeshPart{
        .shape = pinwheel(1.2f, 6),
        .material =
            addTextured(writer, "blades", stripes({0.93f, 0.60f, 0.10f}, vec3(0.94f)), 0.5f)}};
    writer.addNode(
        {.name = "fan", .translation = {3.6f, 2.5f, -0.2f}, .mesh = writer.addMesh("fan", parts)}
    );
}

void addMill(GltfWriter& writer) {
    constexpr vec3 kFoot{6.5f, 0.0f, -9.0f};
    constexpr std::array kTower = {vec2(1.5f, 0.0f), vec2(1.1f, 3.0f), vec2(0.9f, 5.6f)};
    constexpr std::array kCap = {vec2(1.1f, 5.6f), vec2(0.0f, 7.0f)};
    const std::array parts = {
        MeshPart{
            .shape = withUvScale(lathe(kTower, 20), {2.0f, 1.0f}),
            .material = addPlainMaterial(writer, "plaster", {0.72f, 0.66f, 0.56f}, 0.9f)},
        MeshPart{
            .shape = lathe(kCap, 20),
            .material = addPlainMaterial(writer, "thatch", {0.28f, 0.18f, 0.09f}, 0.9f)}};
    writer.addNode(
        {.name = "mill_tower", .translation = kFoot, .mesh = writer.addMesh("mill_tower", parts)}
    );
    Shape sails;
    append(sails, cylinder(0.14f, 0.5f, 12), glm::rotate(mat4(1.0f), glm::half_pi<float>(), kX));
    for (int i = 0; i < 4; ++i) {
        const mat4 spoke =
            glm::rotate(mat4(1.0f), glm::half_pi<float>() * static_cast<float>(i), kZ);
        append(sails, box({0.06f, 1.8f, 0.04f}, 1.0f), glm::translate(spoke, vec3(0, 1.8f, 0.10f)));
        append(
            sails, box({0.30f, 1.3f, 0.015f}, 0.6f), glm::translate(spoke, vec3(0.34f, 2.2f, 0.10f))
        );
    }
    addObject(
        writer,
        {.name = "mill", .translation = kFoot + vec3(0.0f, 5.3f, 1.25f)},
        sails,
        addTextured(writer, "sails", checkers({0.90f, 0.86f, 0.76f}, {0.70f, 0.26f, 0.18f}), 0.8f)
    );
}

/// The brass ring that riders reach for, on a post at the carousel's front.
void addRing(GltfWriter& writer) {
    Shape post;
    append(post, cylinder(0.05f, 2.0f, 10), moved({0.0f, 1.0f, 0.0f}));
    append(post, cylinder(0.30f, 0.10f, 20), moved({0.0f, 0.05f, 0.0f}));
    append(
        post,
        torus(0.20f, 0.035f, 24, 8),
        glm::rotate(moved({0.0f, 2.2f, 0.0f}), glm::half_pi<float>(), kX)
    );
    addObject(
        writer,
        {.name = "ring", .translation = {-1.6f, 0.0f, 2.35f}},
        post,
        writer.addMaterial(
            {.name = "brass", .color = {0.80f, 0.56f, 0.18f}, .metallic = 0.3f, .roughness = 0.3f}
        )
    );
}

} // namespace

GltfWriter buildSpinScene() {
    GltfWriter writer("spin");
    writer.addNode(
        {.name = "front",
         .translation = {0.6f, 2.3f, 8.2f},
         .rotation = glm::angleAxis(-0.03f, kX),
         .camera = writer.addCamera("front", 0.72f, 0.1f)}
    );
    addDemoSun(writer, {0.40f, -0.80f, -0.55f});
    addSquare(writer);
    addCarousel(writer);
    addFan(writer);
    writer.addNode(
        {.name = "close",
         .translation = {2.0f, 2.2f, 3.0f},
         .rotation = rotationTowards({1.5f, 0.25f, -3.2f}),
         .camera = writer.addCamera("close", 0.85f, 0.1f)}
    );
    addMill(writer);
    addRing(writer);
    return writer;
}

} // namespace shutter::generator
