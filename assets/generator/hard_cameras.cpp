// SPDX-License-Identifier: MIT
// Hard cases in which the camera alone moves.
#include "assets/generator/axes.h"
#include "assets/generator/hard_stage.h"
#include "assets/generator/props.h"
#include "assets/generator/textures.h"

#include <glm/gtc/matrix_transform.hpp>

namespace shutter::generator {

namespace {

/// Still things near the camera, so that its motion shows at several depths.
void addForeground(GltfWriter& writer, const CourtyardSurfaces& surfaces) {
    const Index paint = addTextured(writer, "pole_paint", polePaint(), 0.6f);
    const Shape post = withUvScale(cylinder(0.03f, 1.8f, 20), {1.0f, 4.0f});
    addObject(writer, {.name = "post_left", .translation = {-0.85f, 0.9f, 2.6f}}, post, paint);
    addObject(writer, {.name = "post_right", .translation = {1.55f, 0.9f, 1.9f}}, post, paint);
    addObject(
        writer,
        {.name = "crate_near",
         .translation = {1.15f, 0.345f, 2.1f},
         .rotation = glm::angleAxis(0.5f, kY)},
        roundedBox(vec3(0.35f), 0.012f, 1, 0.7f),
        surfaces.crate
    );
    addObject(
        writer,
        {.name = "ball", .translation = {-0.35f, 0.266f, 1.4f}},
        sphere(0.27f, 40, 24),
        addTextured(writer, "beach_ball", beachBall(), 0.45f)
    );
}

} // namespace

GltfWriter buildCameraPanCase() {
    constexpr float kPanPx = 21.0f; // in the middle; further out by the tangent
    GltfWriter writer("camera_pan");
    addPanningCamera(writer, kYardCaseShot, kPanPx);
    const CourtyardSurfaces surfaces = addYardStage(writer);
    addForeground(writer, surfaces);
    return writer;
}

GltfWriter buildCameraDollyCase() {
    constexpr float kAdvance = 0.34f; // metres in an exposure
    GltfWriter writer("camera_dolly");
    const Index camera = writer.addNode(
        {.name = "main",
         .translation = kYardCaseShot.position,
         .rotation = kYardCaseShot.rotation(),
         .camera = writer.addCamera("main", kYardCaseShot.yFov, 0.05f)}
    );
    const vec3 velocity = kYardCaseShot.rotation() * vec3(0.0f, 0.0f, -kAdvance / kExposureSeconds);
    addSteadyTranslation(writer, "camera_dolly_linear", camera, kYardCaseShot.position, velocity);
    const CourtyardSurfaces surfaces = addYardStage(writer);
    addForeground(writer, surfaces);
    return writer;
}

GltfWriter buildCameraOrbitCase() {
    constexpr float kTurn = glm::radians(2.7f); // in an exposure
    constexpr float kDistance = 3.5f;           // metres from the pivot
    constexpr vec3 kPivot{0.0f, 0.0f, 1.2f};
    GltfWriter writer("camera_orbit");
    const Index pivot = writer.addNode({.name = "orbit_pivot", .translation = kPivot});
    addSteadyYaw(writer, "camera_orbit_linear", pivot, 0.0f, spinFor(kTurn));
    writer.addNode(
        {.name = "main",
         .parent = pivot,
         .translation = {0.0f, 1.45f, kDistance},
         .rotation = glm::angleAxis(-0.06f, kX),
         .camera = writer.addCamera("main", kYardCaseShot.yFov, 0.05f)}
    );
    const CourtyardSurfaces surfaces = addYardStage(writer);
    addObject(
        writer,
        {.name = "pedestal", .translation = kPivot + kY * 0.47f},
        roundedBox({0.26f, 0.48f, 0.26f}, 0.02f, 2, 0.6f),
        surfaces.stone
    );
    addObject(
        writer,
        {.name = "jug", .translation = kPivot + kY * 1.21f, .rotation = glm::angleAxis(-0.5f, kY)},
        jug(),
        addTextured(writer, "red_glaze", redGlaze(), 0.35f)
    );
    // Between camera and pivot: these move against the background.
    const Index paint = addTextured(writer, "pole_paint", polePaint(), 0.6f);
    const Shape post = withUvScale(cylinder(0.03f, 1.6f, 20), {1.0f, 4.0f});
    addObject(writer, {.name = "post_left", .translation = {-0.95f, 0.8f, 2.4f}}, post, paint);
    addObject(
        writer,
        {.name = "crate_near",
         .translation = {0.95f, 0.445f, 2.35f},
         .rotation = glm::angleAxis(0.4f, kY)},
        roundedBox(vec3(0.30f, 0.45f, 0.30f), 0.012f, 1, 0.6f),
        surfaces.crate
    );
    return writer;
}

} // namespace shutter::generator
