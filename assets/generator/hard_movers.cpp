// SPDX-License-Identifier: MIT
// Hard cases in which one thing moves before a still camera.
#include "assets/generator/axes.h"
#include "assets/generator/hard_stage.h"
#include "assets/generator/props.h"
#include "assets/generator/textures.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>

namespace shutter::generator {

GltfWriter buildTranslationCase() {
    GltfWriter writer("translation");
    addRoomStage(writer);
    NodeDesc node = crossingNode("glider", kRoomCaseShot, {318.0f, 150.0f}, 2.0f, {24.0f, -5.0f});
    // Banked and turned a little towards the camera, so that both wings show.
    const mat4 pose = glm::rotate(glm::rotate(mat4(1.0f), 0.5f, kX), 0.3f, kY);
    node.mesh = addGliderMesh(writer, 0.62f, pose);
    writer.addNode(node);
    return writer;
}

GltfWriter buildSpinCase() {
    constexpr float kTurn = glm::radians(22.0f); // in an exposure
    GltfWriter writer("spin");
    addStillCamera(writer, kYardCaseShot);
    const CourtyardSurfaces surfaces = addYardStage(writer);
    const vec3 hub = kYardCaseShot.pointAt({318.0f, 158.0f}, 3.2f);
    vec3 stick = hub - kZ * 0.10f;
    stick.y = hub.y / 2.0f;
    addObject(
        writer, {.name = "stick", .translation = stick}, cylinder(0.022f, hub.y, 16), surfaces.wood
    );
    const Index tilt = writer.addNode(
        {.name = "pinwheel_axle", .translation = hub, .rotation = glm::angleAxis(0.25f, kY)}
    );
    addObject(
        writer,
        {.name = "pinwheel", .parent = tilt, .angularVelocity = kZ * -spinFor(kTurn)},
        pinwheel(0.62f, 5),
        addTextured(writer, "chevrons", chevrons(), 0.7f)
    );
    return writer;
}

GltfWriter buildWheelSpokesCase() {
    constexpr float kSpeedPx = 17.0f;
    constexpr float kDepth = 3.9f;
    const HighWheeler parts = highWheeler();
    GltfWriter writer("wheel_spokes");
    addStillCamera(writer, kYardCaseShot);
    const CourtyardSurfaces surfaces = addYardStage(writer);

    vec3 place = kYardCaseShot.pointAt({365.0f, 200.0f}, kDepth);
    place.y = parts.largeRadius + parts.rimRadius;
    const float speed = glm::length(kYardCaseShot.velocityFor({kSpeedPx, 0.0f}, kDepth));
    const Index bicycle = writer.addNode({.name = "bicycle", .translation = place});
    addSteadyTranslation(writer, "bicycle_linear", bicycle, place, kX * speed);
    addObject(writer, {.name = "frame", .parent = bicycle}, parts.frame, surfaces.iron);
    addObject(
        writer,
        {.name = "saddle", .parent = bicycle},
        parts.saddle,
        addTextured(writer, "leather", wood({0.30f, 0.14f, 0.07f}, {0.50f, 0.26f, 0.14f}), 0.5f)
    );
    const auto addWheel = [&](const char* name, vec3 at, const WheelSize& size) {
        writer.addNode(
            {.name = name,
             .parent = bicycle,
             .translation = at,
             .mesh = addWheelMesh(writer, name, size, surfaces),
             .angularVelocity = kZ * (-speed / (size.radius + size.rimRadius))}
        );
    };
    addWheel(
        "large_wheel",
        vec3(0.0f),
        {.radius = parts.largeRadius,
         .rimRadius = parts.rimRadius,
         .spokeRadius = 0.008f,
         .hubRadius = 0.055f,
         .spokeCount = 30}
    );
    addWheel(
        "small_wheel",
        parts.smallWheelAt,
        {.radius = parts.smallRadius,
         .rimRadius = parts.rimRadius,
         .spokeRadius = 0.007f,
         .hubRadius = 0.035f,
         .spokeCount = 14}
    );
    return writer;
}

GltfWriter buildLongMotionCase() {
    GltfWriter writer("long_motion");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    NodeDesc node = crossingNode("glider", kYardCaseShot, {395.0f, 150.0f}, 3.2f, {120.0f, -10.0f});
    const mat4 pose = glm::rotate(glm::rotate(mat4(1.0f), 0.45f, kX), 0.25f, kY);
    node.mesh = addGliderMesh(writer, 0.95f, pose);
    writer.addNode(node);
    return writer;
}

} // namespace shutter::generator
