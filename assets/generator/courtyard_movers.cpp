// SPDX-License-Identifier: MIT
#include "assets/generator/axes.h"
#include "assets/generator/courtyard.h"
#include "assets/generator/textures.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <utility>

namespace shutter::generator {

namespace {

/// Spins by 25 degrees in an exposure: further than the gap between its spokes.
void addSpinningWheel(GltfWriter& writer, const CourtyardSurfaces& surfaces) {
    constexpr float kHubHeight = 1.02f;
    Shape frame;
    for (const float side : {-1.0f, 1.0f}) {
        const glm::mat4 lean = glm::rotate(glm::mat4(1.0f), side * 0.30f, kZ);
        append(
            frame,
            roundedBox({0.045f, 0.56f, 0.03f + 0.003f * side}, 0.01f, 1, 0.5f),
            glm::translate(lean, {0.0f, -0.52f, -0.16f})
        );
    }
    append(
        frame,
        cylinder(0.035f, 0.26f, 16),
        glm::rotate(glm::translate(glm::mat4(1.0f), {0, 0, -0.11f}), glm::half_pi<float>(), kX)
    );
    const Index stand = addObject(
        writer,
        {.name = "wheel_stand",
         .translation = {-1.32f, kHubHeight, 0.9f},
         .rotation = glm::angleAxis(0.42f, kY)},
        frame,
        surfaces.iron
    );
    writer.addNode(
        {.name = "wheel",
         .parent = stand,
         .translation = {0.0f, 0.0f, 0.04f},
         .mesh = addWheelMesh(
             writer,
             "wheel",
             {.radius = 0.80f, .rimRadius = 0.038f, .spokeRadius = 0.016f, .hubRadius = 0.10f},
             surfaces
         ),
         .angularVelocity = vec3(0, 0, -glm::radians(25.0f) / kExposureSeconds)}
    );
}

/// A hand cart whose clip moves the parent; its wheel turns by a velocity of its own, and rolls.
void addCart(GltfWriter& writer, const CourtyardSurfaces& surfaces) {
    constexpr float kRadius = 0.27f;
    constexpr float kRim = 0.025f;
    constexpr float kSpeed = 3.0f; // m/s along +X
    const vec3 start(0.18f, kRadius + kRim - 0.004f, 1.20f);
    const Index cart = writer.addNode({.name = "wheel_cart", .translation = start});

    Shape body = roundedBox({0.33f, 0.14f, 0.17f}, 0.015f, 1, 0.33f);
    addObject(
        writer,
        {.name = "cart_body", .parent = cart, .translation = {0.0f, 0.30f, -0.24f}},
        body,
        surfaces.crate
    );
    Shape poles;
    for (const float z : {-0.34f, -0.14f}) {
        const glm::mat4 at = glm::translate(glm::mat4(1.0f), {-0.45f, 0.30f, z});
        append(poles, cylinder(0.014f, 0.60f, 10), glm::rotate(at, glm::radians(75.0f), kZ));
    }
    append(
        poles,
        cylinder(0.02f, 0.34f, 12),
        glm::rotate(glm::translate(glm::mat4(1.0f), {0, 0, -0.18f}), glm::half_pi<float>(), kX)
    );
    append(
        poles,
        box({0.018f, 0.10f, 0.018f}, 0.3f),
        glm::translate(glm::mat4(1.0f), {0.0f, 0.10f, -0.24f})
    );
    addObject(writer, {.name = "cart_poles", .parent = cart}, poles, surfaces.iron);
    writer.addNode(
        {.name = "cart_wheel",
         .parent = cart,
         .mesh = addWheelMesh(
             writer,
             "cart_wheel",
             {.radius = kRadius,
              .rimRadius = kRim,
              .spokeRadius = 0.010f,
              .hubRadius = 0.045f,
              .spokeCount = 10},
             surfaces
         ),
         .angularVelocity = vec3(0, 0, -kSpeed / (kRadius + kRim))}
    );
    const std::array times = {0.0f, 1.0f};
    const std::array places = {start, start + kX * kSpeed};
    writer.addTranslations(writer.addClip("wheel_cart_linear"), cart, times, places);
}

/// Things that are thrown through the yard.
void addFlyers(GltfWriter& writer) {
    constexpr float kSlideDepth = 5.6f;
    addObject(
        writer,
        {.name = "sliding_box",
         .translation = kCourtyardShot.pointAt({770.0f, 412.0f}, kSlideDepth),
         .linearVelocity = kCourtyardShot.velocityFor({-34.0f, 0.0f}, kSlideDepth)},
        roundedBox({0.46f, 0.30f, 0.30f}, 0.03f, 2, 0.5f),
        addTextured(writer, "chevrons", chevrons(), 0.7f)
    );
    addObject(
        writer,
        {.name = "ball",
         .translation = kCourtyardShot.pointAt({655.0f, 235.0f}, 4.1f),
         .linearVelocity = vec3(4.0f, -1.0f, 11.0f)},
        sphere(0.27f, 40, 24),
        addTextured(writer, "beach_ball", beachBall(), 0.45f)
    );
    // Tilted in its mesh, because a node with a velocity keeps its axes parallel to the world's.
    Shape tilted;
    append(
        tilted,
        roundedBox(vec3(0.26f), 0.03f, 2, 0.52f),
        glm::rotate(glm::mat4(1.0f), 0.7f, glm::normalize(vec3(0.8f, -1.0f, 0.35f)))
    );
    addObject(
        writer,
        {.name = "tumbling_box",
         .translation = kCourtyardShot.pointAt({1010.0f, 262.0f}, 4.3f),
         .linearVelocity = vec3(-5.5f, 2.4f, 1.5f),
         .angularVelocity = vec3(9.0f, 13.0f, -6.0f)},
        tilted,
        addTextured(writer, "toy_block", toyBlock(), 0.6f)
    );
}

/// Is static, in front of everything, where the sliding box passes behind it.
void addPost(GltfWriter& writer) {
    Shape post = withUvScale(cylinder(0.022f, 2.4f, 20), {1.0f, 4.0f});
    append(post, cylinder(0.10f, 0.05f, 24), glm::translate(glm::mat4(1.0f), {0.0f, -1.19f, 0.0f}));
    vec3 foot = kCourtyardShot.pointAt({842.0f, 360.0f}, 2.4f);
    foot.y = 1.19f;
    addObject(
        writer,
        {.name = "post", .translation = foot},
        post,
        addTextured(writer, "pole_paint", polePaint(), 0.6f)
    );
}

} // namespace

Index addWheelMesh(
    GltfWriter& writer, const char* name, const WheelSize& size, const CourtyardSurfaces& surfaces
) {
    Wheel parts = wheel(size);
    const std::array mesh = {
        MeshPart{.shape = std::move(parts.rim), .material = surfaces.rim},
        MeshPart{.shape = std::move(parts.spokes), .material = surfaces.wood},
        MeshPart{.shape = std::move(parts.hub), .material = surfaces.iron},
    };
    return writer.addMesh(name, mesh);
}

void addMovers(GltfWriter& writer, const CourtyardSurfaces& surfaces) {
    addSpinningWheel(writer, surfaces);
    addCart(writer, surfaces);
    addFlyers(writer);
    addPost(writer);
}

} // namespace shutter::generator
