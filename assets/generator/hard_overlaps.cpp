// SPDX-License-Identifier: MIT
// Hard cases in which movers overlap each other, something still, or themselves.
#include "assets/generator/axes.h"
#include "assets/generator/hard_stage.h"
#include "assets/generator/props.h"
#include "assets/generator/textures.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>

namespace shutter::generator {

namespace {

/// Two runners and a deck with crates on it, along X, its foot at the origin.
void addSledge(GltfWriter& writer, Index parent, const CourtyardSurfaces& surfaces) {
    Shape runners;
    for (const float z : {-0.22f, 0.22f}) {
        const std::array<vec2, 5> line = {
            vec2(-0.62f, 0.03f), {0.0f, 0.03f}, {0.45f, 0.03f}, {0.68f, 0.12f}, {0.74f, 0.30f}};
        std::vector<vec3> path;
        for (const vec2 point : smoothCurve(line, 20)) {
            path.emplace_back(point, z);
        }
        append(runners, tube(path, 0.024f, 10));
        for (const float x : {-0.45f, 0.40f}) {
            const std::array stilt = {vec3(x, 0.03f, z), vec3(x, 0.24f, z)};
            append(runners, tube(stilt, 0.016f, 8));
        }
    }
    addObject(writer, {.name = "runners", .parent = parent}, runners, surfaces.iron);
    addObject(
        writer,
        {.name = "deck", .parent = parent, .translation = {-0.02f, 0.26f, 0.0f}},
        roundedBox({0.60f, 0.025f, 0.27f}, 0.01f, 2, 0.5f),
        surfaces.wood
    );
    addObject(
        writer,
        {.name = "crate_load", .parent = parent, .translation = {-0.28f, 0.555f, 0.0f}},
        roundedBox(vec3(0.27f), 0.012f, 1, 0.54f),
        surfaces.crate
    );
    addObject(
        writer,
        {.name = "chest", .parent = parent, .translation = {0.29f, 0.485f, 0.0f}},
        roundedBox({0.24f, 0.20f, 0.22f}, 0.03f, 2, 0.4f),
        addTextured(writer, "chevrons", chevrons(), 0.7f)
    );
}

} // namespace

GltfWriter buildCrossingCase() {
    GltfWriter writer("crossing_same_colour");
    addRoomStage(writer);
    const Index glaze = writer.addMaterial(
        {.name = "orange_glaze", .color = {0.72f, 0.20f, 0.04f}, .roughness = 0.5f}
    );
    addObject(
        writer,
        crossingNode("jug_near", kRoomCaseShot, {292.0f, 192.0f}, 1.95f, {26.0f, 3.0f}),
        jug(),
        glaze
    );
    Shape turned;
    append(turned, jug(), glm::rotate(mat4(1.0f), glm::pi<float>() * 0.9f, kY));
    addObject(
        writer,
        crossingNode("jug_far", kRoomCaseShot, {362.0f, 168.0f}, 2.45f, {-26.0f, 2.0f}),
        turned,
        glaze
    );
    return writer;
}

GltfWriter buildStaticPostCase() {
    constexpr float kDepth = 4.2f;
    GltfWriter writer("static_post");
    addStillCamera(writer, kYardCaseShot);
    const CourtyardSurfaces surfaces = addYardStage(writer);
    vec3 place = kYardCaseShot.pointAt({330.0f, 200.0f}, kDepth);
    place.y = 0.0f;
    const vec3 velocity = kYardCaseShot.velocityFor({32.0f, 0.0f}, kDepth);
    const Index sledge = writer.addNode(
        {.name = "sledge", .translation = startFor(place, velocity), .linearVelocity = velocity}
    );
    addSledge(writer, sledge, surfaces);

    const Index paint = addTextured(writer, "pole_paint", polePaint(), 0.6f);

    struct Post {
        float pixel;
        float depth;
        float radius;
    };

    int number = 1;
    for (const Post& post :
         {Post{262.0f, 2.9f, 0.014f}, {352.0f, 2.4f, 0.024f}, {425.0f, 3.2f, 0.03f}}) {
        vec3 foot = kYardCaseShot.pointAt({post.pixel, 180.0f}, post.depth);
        foot.y = 0.85f;
        Shape rod = withUvScale(cylinder(post.radius, 1.7f, 20), {1.0f, 4.0f});
        append(
            rod, sphere(post.radius * 2.2f, 24, 12), glm::translate(mat4(1.0f), {0.0f, 0.86f, 0.0f})
        );
        addObject(
            writer, {.name = fmt::format("post_{}", number++), .translation = foot}, rod, paint
        );
    }
    return writer;
}

GltfWriter buildSelfOverlapCase() {
    constexpr float kTurn = 0.22f; // radians in an exposure
    GltfWriter writer("self_overlap");
    addRoomStage(writer);
    // The flight is the parent's, the turn is about the coil's own, leaning axis.
    NodeDesc flight = crossingNode("flight", kRoomCaseShot, {325.0f, 165.0f}, 1.95f, {20.0f, 6.0f});
    const Index moving = writer.addNode(flight);
    const Index lean = writer.addNode(
        {.name = "lean",
         .parent = moving,
         .rotation = glm::angleAxis(-0.55f, kZ) * glm::angleAxis(0.35f, kX)}
    );
    addObject(
        writer,
        {.name = "coil", .parent = lean, .angularVelocity = kY * spinFor(kTurn)},
        coilWithRing(),
        addTextured(writer, "copper_paint", rimPaint(), 0.5f)
    );
    return writer;
}

} // namespace shutter::generator
