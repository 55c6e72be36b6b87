// SPDX-License-Identifier: MIT
// Objects of the hard cases, in metres, each with its pivot in its middle unless noted otherwise.
#pragma once

#include "assets/generator/mesh_shapes.h"

#include <glm/glm.hpp>

namespace shutter::generator {

/// A toy aeroplane without engine, nose along +X.
struct Glider {
    Shape body;
    Shape wings; ///< wings, tailplane and fin
};

/// \param length metres from nose to tail; the span is 0.9 of it
[[nodiscard]] Glider glider(float length);

/// Handle towards +X; 0.52 m high.
[[nodiscard]] Shape jug();

/// Blades about Z, each twisted like a propeller's.
[[nodiscard]] Shape pinwheel(float radius, int bladeCount);

/// A helix of four turns about Y, 0.42 m high, with a ring hung into it.
[[nodiscard]] Shape coilWithRing();

/// A frame of bars in the XY plane with a grid of wires in it. \param wireRadius metres
[[nodiscard]] Shape wireGate(glm::vec2 halfExtents, float wireRadius, glm::ivec2 wireCount);

/// A clump of bent, pointed blades; the pivot is on the ground. \param seed makes clumps differ
[[nodiscard]] Shape grassClump(int bladeCount, float height, int seed);

/// A bicycle with a large wheel (radius 0.60 m) at the origin and a small one (radius 0.19 m)
/// behind it: frame, saddle and handle bar, without the wheels. Runs along +X.
struct HighWheeler {
    Shape frame;
    Shape saddle;
    glm::vec3 smallWheelAt{0.0f};
    float largeRadius = 0.0f; ///< metres, to the middle of the rim
    float smallRadius = 0.0f;
    float rimRadius = 0.0f;
};

[[nodiscard]] HighWheeler highWheeler();

} // namespace shutter::generator
