// SPDX-License-Identifier: MIT
#include "assets/generator/axes.h"
#include "assets/generator/scenes.h"
#include "assets/generator/textures.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <span>
#include <string>

namespace shutter::generator {

namespace {

void addShell(GltfWriter& writer) {
    const Index paper = writer.addMaterial(
        {.name = "wallpaper", .texture = writer.addTexture("wallpaper", wallpaper())}
    );
    const Index boards = writer.addMaterial(
        {.name = "floor_planks",
         .texture = writer.addTexture("planks", planks()),
         .roughness = 0.55f}
    );
    const Index white = writer.addMaterial({.name = "white_paint", .color = vec3(0.66f)});
    const Index wool = writer.addMaterial(
        {.name = "rug", .texture = writer.addTexture("rug", rug()), .roughness = 1.0f}
    );
    addObject(
        writer,
        {.name = "back_wall", .translation = {0.0f, 1.5f, -1.85f}},
        box({4.0f, 1.6f, 0.1f}, 0.30f),
        paper
    );
    addObject(
        writer,
        {.name = "floor", .translation = {0.0f, -0.1f, 0.4f}},
        box({4.1f, 0.1f, 2.4f}, 0.96f),
        boards
    );
    addObject(
        writer,
        {.name = "skirting_board", .translation = {0.0f, 0.055f, -1.745f}},
        roundedBox({3.95f, 0.07f, 0.018f}, 0.01f, 2, 1.0f),
        white
    );
    addObject(
        writer,
        {.name = "rug", .translation = {0.1f, 0.004f, -0.15f}},
        roundedBox({1.35f, 0.010f, 0.75f}, 0.006f, 2, 0.9f),
        wool
    );
}

/// A picture in a frame on the wall.
void addPainting(GltfWriter& writer, Index oak) {
    const Index canvas = writer.addMaterial(
        {.name = "landscape",
         .texture = writer.addTexture("landscape", landscape()),
         .roughness = 0.6f}
    );
    const Index frame = addObject(
        writer,
        {.name = "picture_frame", .translation = {0.93f, 1.42f, -1.73f}},
        roundedBox({0.335f, 0.26f, 0.022f}, 0.012f, 2, 0.5f),
        oak
    );
    Shape sheet = box({0.29f, 0.215f, 0.004f}, 1.0f);
    for (size_t i = 0; i < sheet.uvs.size(); ++i) {
        sheet.uvs[i] = vec2(sheet.positions[i].x / 0.58f, -sheet.positions[i].y / 0.43f) + 0.5f;
    }
    addObject(
        writer,
        {.name = "picture", .parent = frame, .translation = {0.0f, 0.0f, 0.021f}},
        sheet,
        canvas
    );
}

void addSofa(GltfWriter& writer, Index oak) {
    const Index fabric = writer.addMaterial(
        {.name = "sofa_fabric",
         .texture = writer.addTexture("woven_check", wovenCheck()),
         .roughness = 0.95f}
    );
    constexpr float kTile = 0.26f; // metres: checks of 65 mm
    const Index sofa = addObject(
        writer,
        {.name = "sofa", .translation = {0.1f, 0.20f, -1.03f}},
        roundedBox({0.90f, 0.11f, 0.44f}, 0.03f, 2, kTile),
        fabric
    );
    const auto addPart = [&](const char* name, vec3 at, vec3 half, float radius, glm::quat rotation
                         ) {
        addObject(
            writer,
            {.name = name, .parent = sofa, .translation = at, .rotation = rotation},
            roundedBox(half, radius, 3, kTile),
            fabric
        );
    };
    const glm::quat upright(1.0f, 0.0f, 0.0f, 0.0f);
    addPart("sofa_back", {0.0f, 0.27f, -0.40f}, {0.93f, 0.37f, 0.10f}, 0.06f, turned(-0.10f, kX));
    addPart("sofa_arm_left", {-0.98f, 0.13f, 0.01f}, {0.12f, 0.25f, 0.47f}, 0.08f, upright);
    addPart("sofa_arm_right", {0.98f, 0.13f, 0.01f}, {0.12f, 0.25f, 0.47f}, 0.08f, upright);
    addPart("seat_cushion_left", {-0.432f, 0.165f, 0.065f}, {0.43f, 0.085f, 0.42f}, 0.05f, upright);
    addPart("seat_cushion_right", {0.432f, 0.167f, 0.065f}, {0.43f, 0.085f, 0.42f}, 0.05f, upright);
    addPart(
        "back_cushion_left",
        {-0.430f, 0.46f, -0.22f},
        {0.425f, 0.24f, 0.09f},
        0.07f,
        turned(-0.2f, kX)
    );
    addPart(
        "back_cushion_right",
        {0.430f, 0.462f, -0.22f},
        {0.425f, 0.24f, 0.09f},
        0.07f,
        turned(-0.2f, kX)
    );

    const Shape leg = cylinder(0.028f, 0.13f, 12);
    int number = 1;
    for (const vec2 corner :
         {vec2(-0.85f, 0.36f), {0.85f, 0.36f}, {-0.85f, -0.36f}, {0.85f, -0.36f}}) {
        addObject(
            writer,
            {.name = "sofa_leg_" + std::to_string(number++),
             .parent = sofa,
             .translation = {corner.x, -0.145f, corner.y}},
            leg,
            oak
        );
    }
}

void addCushions(GltfWriter& writer) {
    const Index pink = writer.addMaterial(
        {.name = "pink_cushion",
         .texture = writer.addTexture("pink_lattice", pinkLattice()),
         .roughness = 0.9f}
    );
    const Index blue = writer.addMaterial(
        {.name = "blue_cushion",
         .texture = writer.addTexture("blue_herringbone", blueHerringbone()),
         .roughness = 0.9f}
    );
    addObject(
        writer,
        {.name = "pink_cushion",
         .translation = {-0.31f, 0.725f, -0.90f},
         .rotation = turned(-0.30f, kX) * turned(-0.42f, kZ)},
        pillow({0.29f, 0.27f, 0.10f}, 0.10f, 18),
        pink
    );
    addObject(
        writer,
        {.name = "blue_cushion",
         .translation = {0.72f, 0.67f, -0.92f},
         .rotation = turned(-0.25f, kY) * turned(-0.30f, kX) * turned(0.12f, kZ)},
        pillow({0.22f, 0.21f, 0.085f}, 0.09f, 12),
        blue
    );
}

/// Its shade glows by itself; the light of the scene comes from elsewhere.
void addFloorLamp(GltfWriter& writer) {
    const Index brass = writer.addMaterial(
        {.name = "brass", .color = {0.83f, 0.62f, 0.30f}, .metallic = 0.6f, .roughness = 0.35f}
    );
    const Index shade = writer.addMaterial(
        {.name = "lamp_shade", .color = {0.62f, 0.54f, 0.40f}, .emissive = {0.34f, 0.26f, 0.15f}}
    );
    Shape stand = cylinder(0.012f, 1.29f, 12);
    append(
        stand, cylinder(0.15f, 0.03f, 32), glm::translate(glm::mat4(1.0f), {0.0f, -0.64f, 0.0f})
    );
    const Index lamp = addObject(
        writer, {.name = "floor_lamp", .translation = {-1.22f, 0.65f, -1.40f}}, stand, brass
    );
    constexpr std::array<vec2, 5> kShadeProfile = {
        vec2(0.20f, -0.15f), {0.14f, 0.15f}, {0.132f, 0.15f}, {0.192f, -0.15f}, {0.20f, -0.15f}};
    Shape cone;
    for (size_t i = 0; i + 1 < kShadeProfile.size(); ++i) {
        append(cone, lathe(std::span(kShadeProfile).subspan(i, 2), 40));
    }
    addObject(
        writer, {.name = "lamp_shade", .parent = lamp, .translation = {0, 0.66f, 0}}, cone, shade
    );
}

/// A round table with three books.
void addSideTable(GltfWriter& writer, Index oak) {
    Shape table = cylinder(0.24f, 0.035f, 40);
    append(table, cylinder(0.03f, 0.50f, 16), glm::translate(glm::mat4(1.0f), {0, -0.24f, 0}));
    append(table, cylinder(0.16f, 0.03f, 32), glm::translate(glm::mat4(1.0f), {0, -0.49f, 0}));
    const Index top = addObject(
        writer, {.name = "side_table", .translation = {1.52f, 0.50f, -0.92f}}, table, oak
    );

    struct Book {
        const char* name;
        vec3 half;
        vec3 color;
        float y;
        float yaw;
    };

    for (const Book& book : {
             Book{"book_green", {0.13f, 0.018f, 0.09f}, {0.10f, 0.26f, 0.18f}, 0.034f, 0.3f},
             Book{"book_ochre", {0.12f, 0.014f, 0.085f}, {0.62f, 0.36f, 0.08f}, 0.065f, 0.1f},
             Book{"book_blue", {0.10f, 0.020f, 0.075f}, {0.08f, 0.16f, 0.34f}, 0.098f, 0.5f},
         }) {
        addObject(
            writer,
            {.name = book.name,
             .parent = top,
             .translation = {0.0f, book.y, 0.0f},
             .rotation = turned(book.yaw, kY)},
            roundedBox(book.half, 0.004f, 1, 0.3f),
            writer.addMaterial({.name = book.name, .color = book.color, .roughness = 0.6f})
        );
    }
}

} // namespace

void addRoomLights(GltfWriter& writer) {
    writer.addNode(
        {.name = "sun",
         .translation = {-2.0f, 3.0f, 2.0f},
         .rotation = rotationTowards({0.55f, -0.62f, -0.75f}),
         .light = writer.addLight(
             "sun", {.directional = true, .color = {1.0f, 0.96f, 0.88f}, .intensity = 2.9f}
         )}
    );
    writer.addNode(
        {.name = "fill_lamp",
         .translation = {1.3f, 1.7f, 1.1f},
         .light = writer.addLight("fill_lamp", {.color = {0.90f, 0.95f, 1.0f}, .intensity = 6.0f})}
    );
}

void addRoom(GltfWriter& writer) {
    const Index oak = writer.addMaterial(
        {.name = "oak",
         .texture = writer.addTexture("oak", wood({0.36f, 0.22f, 0.12f}, {0.62f, 0.42f, 0.25f})),
         .roughness = 0.6f}
    );
    addShell(writer);
    addPainting(writer, oak);
    addSofa(writer, oak);
    addCushions(writer);
    addFloorLamp(writer);
    addSideTable(writer, oak);
}

} // namespace shutter::generator
