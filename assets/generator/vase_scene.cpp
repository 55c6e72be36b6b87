// SPDX-License-Identifier: MIT
// A red vase crosses in front of a white sofa with a pink cushion: the shot on which the paper
// compares methods ("Graphics Quality Comparison"). The cushion's silhouette, the sofa's back and
// the wall run on behind the vase, so that a guessed background shows.
#include "assets/generator/axes.h"
#include "assets/generator/scenes.h"
#include "assets/generator/textures.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>

namespace shutter::generator {

namespace {

const Shot kShot{
    .position = {-0.55f, 1.16f, 2.25f},
    .yaw = -0.16f,
    .pitch = -0.125f,
    .yFov = 0.6f,
};

constexpr vec2 kVasePx{604.0f, 352.0f}; ///< the vase's middle at time 0
constexpr float kVaseDepth = 2.2f;      ///< metres; at least 0.5 in front of the sofa
constexpr vec2 kVaseMotionPx{38.0f, 14.0f};

void addVase(GltfWriter& writer) {
    // Radius and height from the foot; the pivot is halfway up.
    constexpr float kHalfHeight = 0.26f;
    constexpr std::array<vec2, 10> kOutside = {
        vec2(0.066f, 0.000f),
        {0.066f, 0.015f},
        {0.080f, 0.075f},
        {0.116f, 0.170f},
        {0.138f, 0.265f},
        {0.124f, 0.350f},
        {0.076f, 0.415f},
        {0.056f, 0.455f},
        {0.068f, 0.500f},
        {0.088f, 0.520f}};
    constexpr std::array<vec2, 3> kLip = {
        vec2(0.088f, 0.520f), {0.084f, 0.5245f}, {0.079f, 0.521f}};
    constexpr std::array<vec2, 8> kInside = {
        vec2(0.079f, 0.521f),
        {0.060f, 0.500f},
        {0.049f, 0.455f},
        {0.068f, 0.415f},
        {0.116f, 0.350f},
        {0.129f, 0.265f},
        {0.075f, 0.080f},
        {0.000f, 0.030f}};
    constexpr std::array<vec2, 2> kFoot = {vec2(0.0f, 0.0f), {0.066f, 0.0f}};
    constexpr int kSegments = 64;
    const glm::mat4 toPivot = glm::translate(glm::mat4(1.0f), {0.0f, -kHalfHeight, 0.0f});

    MeshPart body;
    append(body.shape, lathe(smoothCurve(kOutside, 27), kSegments), toPivot);
    body.material = writer.addMaterial(
        {.name = "red_glaze",
         .texture = writer.addTexture("red_glaze", redGlaze()),
         .roughness = 0.35f}
    );
    MeshPart plain;
    append(plain.shape, lathe(smoothCurve(kLip, 3), kSegments), toPivot);
    append(plain.shape, lathe(smoothCurve(kInside, 10), kSegments), toPivot);
    append(plain.shape, lathe(kFoot, kSegments), toPivot);
    plain.material = writer.addMaterial(
        {.name = "dark_glaze", .color = {0.23f, 0.015f, 0.015f}, .roughness = 0.4f}
    );
    const std::array parts = {body, plain};
    writer.addNode(
        {.name = "vase",
         .translation = kShot.pointAt(kVasePx, kVaseDepth),
         .mesh = writer.addMesh("vase", parts),
         .linearVelocity = kShot.velocityFor(kVaseMotionPx, kVaseDepth)}
    );
}

} // namespace

GltfWriter buildVaseScene() {
    GltfWriter writer("vase");
    writer.addNode(
        {.name = "main",
         .translation = kShot.position,
         .rotation = kShot.rotation(),
         .camera = writer.addCamera("main", kShot.yFov, 0.05f)}
    );
    addRoomLights(writer);
    addRoom(writer);
    addVase(writer);
    return writer;
}

} // namespace shutter::generator
