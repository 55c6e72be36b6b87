// SPDX-License-Identifier: MIT
// Many movers in different directions at once: spin, translation, tumbling, towards the camera,
// under a moving parent, behind a static post; and a camera that pans.
#include "assets/generator/axes.h"
#include "assets/generator/courtyard.h"
#include "assets/generator/scenes.h"
#include "assets/generator/textures.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <string>

namespace shutter::generator {

namespace {

constexpr float kYardHalfWidth = 6.0f;
constexpr float kBackWallZ = -3.6f; ///< its face

void addWindow(GltfWriter& writer, int number, vec3 at, Index panes, Index stoneTrim) {
    const std::string name = "window_" + std::to_string(number);
    Shape frame;
    const auto addBar = [&](vec3 centre, vec3 half) {
        append(frame, box(half, 0.5f), glm::translate(glm::mat4(1.0f), centre));
    };
    // Bars overlap in depth by different amounts, so that no two faces lie in one plane.
    addBar({0.0f, 0.68f, 0.02f}, {0.54f, 0.08f, 0.085f});
    addBar({0.0f, -0.67f, 0.03f}, {0.58f, 0.06f, 0.11f});
    addBar({-0.45f, 0.0f, 0.0f}, {0.05f, 0.62f, 0.07f});
    addBar({0.45f, 0.0f, 0.0f}, {0.05f, 0.62f, 0.07f});
    const Index trim =
        addObject(writer, {.name = name + "_trim", .translation = at}, frame, stoneTrim);
    Shape glass = box({0.41f, 0.615f, 0.03f}, 1.0f);
    for (size_t i = 0; i < glass.uvs.size(); ++i) {
        glass.uvs[i] = vec2(glass.positions[i].x / 0.82f, -glass.positions[i].y / 1.23f) + 0.5f;
    }
    addObject(writer, {.name = name, .parent = trim, .translation = {0, 0, 0.005f}}, glass, panes);
}

void addWalls(GltfWriter& writer, const CourtyardSurfaces& surfaces) {
    constexpr float kBrickTile = 1.12f; // metres: bricks of 280 x 140 mm
    addObject(
        writer,
        {.name = "ground", .translation = {0.0f, -0.1f, 1.0f}},
        box({kYardHalfWidth + 0.5f, 0.1f, 6.0f}, 1.8f),
        addTextured(writer, "paving", paving(), 0.9f)
    );
    const auto addWall = [&](const char* name, vec3 at, vec3 half) {
        const Index wall = addObject(
            writer, {.name = name, .translation = at}, box(half, kBrickTile), surfaces.bricks
        );
        addObject(
            writer,
            {.name = std::string(name) + "_coping",
             .parent = wall,
             .translation = {0.0f, half.y + 0.05f, 0.0f}},
            roundedBox({half.x + 0.07f, 0.08f, half.z + 0.07f}, 0.02f, 1, 0.6f),
            surfaces.stone
        );
    };
    addWall("back_wall", {0, 1.25f, kBackWallZ - 0.2f}, {kYardHalfWidth, 1.31f, 0.2f});
    addWall("left_wall", {-kYardHalfWidth - 0.15f, 0.95f, 1.05f}, {0.2f, 1.0f, 5.0f});
    addWall("right_wall", {kYardHalfWidth + 0.15f, 0.95f, 1.05f}, {0.2f, 1.0f, 5.0f});

    const Index panes = addTextured(writer, "window_panes", windowPanes(), 0.3f);
    int number = 1;
    for (const float x : {-3.75f, -1.25f, 1.25f, 3.75f}) {
        addWindow(writer, number++, {x, 1.45f, kBackWallZ}, panes, surfaces.stone);
    }
    for (const float z : {-1.6f, 1.2f}) {
        // A buttress on each side wall keeps the pan from sweeping an empty plane.
        for (const float side : {-1.0f, 1.0f}) {
            addObject(
                writer,
                {.name = fmt::format("buttress_{}_{}", side < 0 ? "left" : "right", z < 0 ? 1 : 2),
                 .translation = {side * (kYardHalfWidth - 0.10f), 0.75f, z}},
                roundedBox({0.22f, 0.81f, 0.30f}, 0.03f, 1, 0.6f),
                surfaces.stone
            );
        }
    }
}

void addColumnsAndCrates(GltfWriter& writer, const CourtyardSurfaces& surfaces) {
    constexpr std::array<vec2, 7> kShaft = {
        vec2(0.17f, 0.0f),
        {0.165f, 0.1f},
        {0.16f, 0.7f},
        {0.155f, 1.2f},
        {0.145f, 1.7f},
        {0.15f, 1.78f},
        {0.18f, 1.84f}};
    constexpr std::array<vec2, 2> kBottom = {vec2(0.0f, 0.0f), kShaft.front()};
    constexpr std::array<vec2, 2> kTop = {kShaft.back(), vec2(0.0f, kShaft.back().y)};
    Shape column = withUvScale(lathe(smoothCurve(kShaft, 14), 32), {2.0f, 3.0f});
    append(column, lathe(kBottom, 32));
    append(column, lathe(kTop, 32));
    for (const float y : {0.02f, 1.90f}) {
        append(
            column,
            roundedBox({0.23f, 0.075f, 0.23f}, 0.02f, 1, 0.6f),
            glm::translate(glm::mat4(1.0f), {0.0f, y, 0.0f})
        );
    }
    int number = 1;
    for (const float x : {-2.50f, 0.0f, 2.50f}) {
        addObject(
            writer,
            {.name = "column_" + std::to_string(number++),
             .translation = {x, 0.05f, kBackWallZ + 0.55f}},
            column,
            surfaces.stone
        );
    }

    struct Crate {
        vec3 at;
        float half;
        float yaw;
    };

    number = 1;
    for (const Crate& crate : {
             Crate{{-3.15f, 0.345f, -2.2f}, 0.35f, 0.35f},
             Crate{{-3.25f, 0.935f, -2.25f}, 0.25f, -0.2f},
             Crate{{2.05f, 0.395f, -2.1f}, 0.40f, -0.4f},
             Crate{{2.95f, 0.295f, -1.8f}, 0.30f, 0.15f},
             Crate{{0.62f, 0.245f, -2.5f}, 0.25f, 0.6f},
             Crate{{5.0f, 0.445f, -0.2f}, 0.45f, 0.3f},
         }) {
        addObject(
            writer,
            {.name = "crate_" + std::to_string(number++),
             .translation = crate.at,
             .rotation = glm::angleAxis(crate.yaw, kY)},
            roundedBox(vec3(crate.half), 0.012f, 1, crate.half * 2.0f),
            surfaces.crate
        );
    }
}

void addCameras(GltfWriter& writer) {
    writer.addNode(
        {.name = "main",
         .translation = kCourtyardShot.position,
         .rotation = kCourtyardShot.rotation(),
         .camera = writer.addCamera("main", kCourtyardShot.yFov, 0.05f)}
    );
    // Level, so that the shortest way between two keys is a rotation about Y and nothing else.
    constexpr float kPanPx = 20.0f;    // at the middle of the picture, in one exposure
    constexpr float kFirstYaw = 0.06f; // radians; the pan turns to the right from there
    const float radians = std::atan(kPanPx / kCourtyardShot.focalLengthPx()) / kExposureSeconds;
    const glm::quat first = glm::angleAxis(kFirstYaw, kY);
    const glm::quat last = glm::angleAxis(kFirstYaw - radians, kY);
    const Index pan = writer.addNode(
        {.name = "pan",
         .translation = kCourtyardShot.position,
         .rotation = first,
         .camera = writer.addCamera("pan", kCourtyardShot.yFov, 0.05f)}
    );
    const std::array times = {0.0f, 1.0f};
    const std::array turns = {first, last};
    writer.addRotations(writer.addClip("camera_pan_linear"), pan, times, turns);
}

} // namespace

CourtyardSurfaces addCourtyardSurfaces(GltfWriter& writer) {
    return {
        .bricks = addTextured(writer, "bricks", bricks(), 0.95f),
        .stone = addTextured(writer, "stone", stone({0.80f, 0.76f, 0.68f}), 0.9f),
        .crate = addTextured(writer, "crate_boards", crateBoards(), 0.85f),
        .iron = writer.addMaterial(
            {.name = "iron",
             .color = vec3(0.10f, 0.11f, 0.13f),
             .metallic = 0.3f,
             .roughness = 0.5f}
        ),
        .wood = addTextured(
            writer, "painted_wood", wood({0.50f, 0.16f, 0.10f}, {0.80f, 0.36f, 0.20f}), 0.7f
        ),
        .rim = addTextured(writer, "rim_paint", rimPaint(), 0.6f),
    };
}

void addCourtyardLights(GltfWriter& writer) {
    writer.addNode(
        {.name = "sun",
         .translation = {-4.0f, 6.0f, 4.0f},
         .rotation = rotationTowards({0.60f, -0.75f, -0.62f}),
         .light = writer.addLight(
             "sun", {.directional = true, .color = {1.0f, 0.95f, 0.86f}, .intensity = 3.1f}
         )}
    );
    writer.addNode(
        {.name = "lantern",
         .translation = {2.2f, 2.4f, 2.0f},
         .light = writer.addLight("lantern", {.color = {0.85f, 0.92f, 1.0f}, .intensity = 5.5f})}
    );
}

void addStillYard(GltfWriter& writer, const CourtyardSurfaces& surfaces) {
    addWalls(writer, surfaces);
    addColumnsAndCrates(writer, surfaces);
}

GltfWriter buildCourtyardScene() {
    GltfWriter writer("courtyard");
    addCameras(writer);
    addCourtyardLights(writer);
    const CourtyardSurfaces surfaces = addCourtyardSurfaces(writer);
    addStillYard(writer, surfaces);
    addMovers(writer, surfaces);
    return writer;
}

} // namespace shutter::generator
