// SPDX-License-Identifier: MIT
// What the still yard and the things that move in it share.
#pragma once

#include "assets/generator/gltf_writer.h"
#include "assets/generator/scenes.h"

namespace shutter::generator {

/// The view of camera `main`, in which places and motions are laid out.
inline const Shot kCourtyardShot{
    .position = {0.0f, 1.45f, 5.2f}, .yaw = 0.0f, .pitch = -0.02f, .yFov = 0.72f};

/// Materials that several objects share.
struct CourtyardSurfaces {
    Index bricks;
    Index stone;
    Index crate;
    Index iron;
    Index wood;
    Index rim;
};

[[nodiscard]] CourtyardSurfaces addCourtyardSurfaces(GltfWriter& writer);

/// `sun` and `lantern`.
void addCourtyardLights(GltfWriter& writer);

/// Ground, walls, windows, columns and crates.
void addStillYard(GltfWriter& writer, const CourtyardSurfaces& surfaces);

/// A mesh of rim, spokes and hub.
Index addWheelMesh(
    GltfWriter& writer, const char* name, const WheelSize& size, const CourtyardSurfaces& surfaces
);

/// Every object in the yard that moves, and the post in front of them that does not.
void addMovers(GltfWriter& writer, const CourtyardSurfaces& surfaces);

} // namespace shutter::generator
