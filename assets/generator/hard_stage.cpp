// SPDX-License-Identifier: MIT
#include "assets/generator/hard_stage.h"

#include "assets/generator/props.h"
#include "assets/generator/textures.h"

#include <array>
#include <cmath>

namespace shutter::generator {

namespace {

constexpr auto kSeconds = static_cast<float>(kCaseSeconds);
constexpr std::array kClipTimes = {0.0f, 2.0f * kSeconds};

// Shot computes speeds from the one exposure.
static_assert(static_cast<float>(kCaseExposureSeconds) == kExposureSeconds);

} // namespace

void addRoomStage(GltfWriter& writer) {
    addStillCamera(writer, kRoomCaseShot);
    addRoomLights(writer);
    addRoom(writer);
}

CourtyardSurfaces addYardStage(GltfWriter& writer) {
    addCourtyardLights(writer);
    const CourtyardSurfaces surfaces = addCourtyardSurfaces(writer);
    addStillYard(writer, surfaces);
    return surfaces;
}

void addStillCamera(GltfWriter& writer, const Shot& shot) {
    writer.addNode(
        {.name = "main",
         .translation = shot.position,
         .rotation = shot.rotation(),
         .camera = writer.addCamera("main", shot.yFov, 0.05f)}
    );
}

void addPanningCamera(GltfWriter& writer, const Shot& shot, float pixels) {
    // The pivot turns about Y and carries the pitch, so that the turn is exact between two keys.
    const Index pivot = writer.addNode({.name = "pan_pivot", .translation = shot.position});
    const float turn = std::atan(pixels / shot.focalLengthPx()) / kExposureSeconds;
    addSteadyYaw(writer, "camera_pan_linear", pivot, shot.yaw, -turn);
    writer.addNode(
        {.name = "main",
         .parent = pivot,
         .rotation = glm::angleAxis(shot.pitch, glm::vec3(1, 0, 0)),
         .camera = writer.addCamera("main", shot.yFov, 0.05f)}
    );
}

void addSteadyTranslation(
    GltfWriter& writer, const char* name, Index node, glm::vec3 place, glm::vec3 velocity
) {
    const std::array places = {place - velocity * kSeconds, place + velocity * kSeconds};
    writer.addTranslations(writer.addClip(name), node, kClipTimes, places);
}

void addSteadyYaw(GltfWriter& writer, const char* name, Index node, float yaw, float turn) {
    const glm::vec3 up(0, 1, 0);
    const std::array turns = {
        glm::angleAxis(yaw - turn * kSeconds, up), glm::angleAxis(yaw + turn * kSeconds, up)};
    writer.addRotations(writer.addClip(name), node, kClipTimes, turns);
}

glm::vec3 startFor(glm::vec3 place, glm::vec3 velocity) {
    return place - velocity * kSeconds;
}

NodeDesc
crossingNode(const char* name, const Shot& shot, glm::vec2 pixel, float depth, glm::vec2 pixels) {
    const glm::vec3 velocity = shot.velocityFor(pixels, depth);
    return {
        .name = name,
        .translation = startFor(shot.pointAt(pixel, depth), velocity),
        .linearVelocity = velocity};
}

Index addGliderMesh(GltfWriter& writer, float length, const glm::mat4& pose) {
    const Glider parts = glider(length);
    std::array<MeshPart, 2> mesh;
    append(mesh[0].shape, parts.body, pose);
    mesh[0].material = addTextured(writer, "glider_body", polePaint(), 0.5f);
    append(mesh[1].shape, parts.wings, pose);
    mesh[1].material = addTextured(writer, "glider_wings", chevrons(), 0.7f);
    return writer.addMesh("glider", mesh);
}

float spinFor(float radians) {
    return radians / kExposureSeconds;
}

} // namespace shutter::generator
