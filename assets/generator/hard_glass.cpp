// SPDX-License-Identifier: MIT
// Hard cases of glass: surfaces that what lies behind them is seen through.
#include "assets/generator/axes.h"
#include "assets/generator/hard_stage.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/textures.h"

#include <fmt/format.h>

#include <array>

namespace shutter::generator {

namespace {

Index addGlass(GltfWriter& writer, const char* name, vec3 color, float alpha) {
    return writer.addMaterial(
        {.name = name, .color = color, .roughness = 0.2f, .doubleSided = true, .alpha = alpha}
    );
}

/// An upright pane, parallel to the picture. \param halfExtents metres
Shape upright(vec2 halfExtents) {
    return box({halfExtents.x, halfExtents.y, 0.004f}, 1.0f);
}

} // namespace

GltfWriter buildSlidingPaneCase() {
    constexpr float kTurn = 0.35f; // radians in an exposure
    GltfWriter writer("sliding_pane");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    const Index carrier = writer.addNode(
        crossingNode("carrier", kYardCaseShot, {320.0f, 190.0f}, 3.2f, {30.0f, -6.0f})
    );
    const Index pane = addObject(
        writer,
        {.name = "pane", .parent = carrier, .angularVelocity = kZ * spinFor(kTurn)},
        upright({0.55f, 0.35f}),
        addGlass(writer, "blue_glass", {0.15f, 0.4f, 0.8f}, 0.55f)
    );
    addObject(
        writer,
        {.name = "rail", .parent = pane, .translation = kY * 0.4f},
        box({0.6f, 0.05f, 0.03f}, 0.5f),
        addTextured(writer, "rail_paint", polePaint(), 0.5f)
    );
    return writer;
}

GltfWriter buildBehindGlassCase() {
    struct Pane {
        vec2 pixel;
        float depth;
        vec3 color;
    };

    constexpr std::array kPanes{
        Pane{{250.0f, 190.0f}, 2.2f, {0.8f, 0.7f, 0.3f}},
        Pane{{380.0f, 200.0f}, 2.6f, {0.2f, 0.7f, 0.4f}},
        Pane{{320.0f, 170.0f}, 4.4f, {0.7f, 0.2f, 0.3f}}};
    GltfWriter writer("mover_behind_glass");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    addObject(
        writer,
        crossingNode("crate", kYardCaseShot, {320.0f, 195.0f}, 3.4f, {30.0f, 0.0f}),
        box({0.32f, 0.32f, 0.32f}, 0.64f),
        addTextured(writer, "crate", crateBoards(), 0.8f)
    );
    int number = 1;
    for (const Pane& pane : kPanes)
        addObject(
            writer,
            {.name = fmt::format("pane_{}", number),
             .translation = kYardCaseShot.pointAt(pane.pixel, pane.depth)},
            upright({0.4f, 0.45f}),
            addGlass(writer, fmt::format("glass_{}", number++).c_str(), pane.color, 0.45f)
        );
    return writer;
}

GltfWriter buildGlassCarriageCase() {
    constexpr vec2 kHalf{0.55f, 0.4f};
    constexpr float kBar = 0.05f;
    GltfWriter writer("glass_carriage");
    addStillCamera(writer, kYardCaseShot);
    addYardStage(writer);
    const Index carriage = writer.addNode(
        crossingNode("carriage", kYardCaseShot, {320.0f, 190.0f}, 3.0f, {34.0f, 0.0f})
    );
    Shape frame;
    for (const float side : {-1.0f, 1.0f}) {
        append(
            frame,
            box({kBar, kHalf.y + kBar, kBar}, 0.5f),
            glm::translate(mat4(1.0f), kX * (side * kHalf.x))
        );
        append(
            frame,
            box({kHalf.x, kBar, kBar}, 0.5f),
            glm::translate(mat4(1.0f), kY * (side * kHalf.y))
        );
    }
    addObject(
        writer,
        {.name = "frame", .parent = carriage},
        frame,
        addTextured(writer, "frame_paint", polePaint(), 0.5f)
    );
    addObject(
        writer,
        {.name = "rider", .parent = carriage, .translation = {0.1f, -0.08f, -0.35f}},
        sphere(0.24f, 32, 16),
        addTextured(writer, "ball", beachBall(), 0.5f)
    );
    addObject(
        writer,
        {.name = "window", .parent = carriage},
        upright(kHalf),
        addGlass(writer, "window_glass", {0.3f, 0.55f, 0.5f}, 0.4f)
    );
    return writer;
}

} // namespace shutter::generator
