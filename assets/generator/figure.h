// SPDX-License-Identifier: MIT
// A person: one skinned mesh over thirteen joints, and clips in which it walks or runs.
#pragma once

#include "assets/generator/gltf_writer.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstdint>
#include <string>

namespace shutter::generator {

/// In the order of the skin's joints; parents come first.
enum Joint : uint16_t {
    Hips,
    Chest,
    Head,
    LeftArm,
    LeftForearm,
    RightArm,
    RightForearm,
    LeftThigh,
    LeftShin,
    LeftFoot,
    RightThigh,
    RightShin,
    RightFoot,
    kJointCount,
};

/// How a figure goes: angles are the largest, radians.
struct Gait {
    float strideSeconds = 1.0f; ///< both legs once
    float phase = 0.0f;         ///< share of a stride by which it is ahead
    float thighSwing = 0.45f;
    float kneeBend = 0.7f;
    float armSwing = 0.5f;
    float elbowBend = 0.3f;
    float lean = 0.04f; ///< forward
    float bob = 0.025f; ///< of the hips, metres
};

[[nodiscard]] Gait makeRun();

/// A figure 1.75 m high on the ground at the origin, facing +Z. \param coat, trousers linear
Index addFigureMesh(
    GltfWriter& writer, const std::string& name, glm::vec3 coat, glm::vec3 trousers
);

/// A figure and its skeleton; `root` carries it.
struct Figure {
    Index root = kNothing;
    std::array<Index, kJointCount> joints{};
};

/// \param mesh of addFigureMesh() \param place of the root: its name begins all the figure's names
Figure addFigure(GltfWriter& writer, Index mesh, const NodeDesc& place);

/// Adds the joints' channels from `begin` to `end`, seconds; at `begin` and `begin` plus whole
/// strides they are the same.
void addGait(
    GltfWriter& writer, Index clip, const Figure& figure, const Gait& gait, float begin, float end
);

} // namespace shutter::generator
