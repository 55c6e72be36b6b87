// SPDX-License-Identifier: MIT
// What the hard cases share: where they take place, how they are framed, and how things move so
// that they are where they were laid out at the case's time.
#pragma once

#include "assets/generator/courtyard.h"
#include "assets/generator/gltf_writer.h"
#include "assets/generator/hard_cases.h"
#include "assets/generator/scenes.h"

#include <glm/glm.hpp>

namespace shutter::generator {

/// The room, seen by a still camera `main`; lit.
inline const Shot kRoomCaseShot{
    .position = {-0.45f, 1.14f, 2.25f},
    .yaw = -0.13f,
    .pitch = -0.13f,
    .yFov = 0.6f,
    .pictureSizePx = kCaseSizePx};
void addRoomStage(GltfWriter& writer);

/// The courtyard without its movers; lit, with no camera.
inline const Shot kYardCaseShot{
    .position = {0.0f, 1.45f, 5.2f},
    .yaw = 0.0f,
    .pitch = -0.03f,
    .yFov = 0.72f,
    .pictureSizePx = kCaseSizePx};
CourtyardSurfaces addYardStage(GltfWriter& writer);

/// A still camera `main`.
void addStillCamera(GltfWriter& writer, const Shot& shot);

/// Camera `main`, which turns to the right about Y at `pixels` of the picture's middle in an
/// exposure; at the case's time it has the shot's yaw.
void addPanningCamera(GltfWriter& writer, const Shot& shot, float pixels);

/// Clips of a steady motion that passes `place` (or `yaw`) at the case's time, from time 0 to twice
/// that.
/// \param velocity m/s \param turn rad/s about Y, at most half a turn in the clip
void addSteadyTranslation(
    GltfWriter& writer, const char* name, Index node, glm::vec3 place, glm::vec3 velocity
);
void addSteadyYaw(GltfWriter& writer, const char* name, Index node, float yaw, float turn);

/// Place at time 0 of a node with that velocity that is at `place` at the case's time.
[[nodiscard]] glm::vec3 startFor(glm::vec3 place, glm::vec3 velocity);

/// A node with a velocity of `pixels` in an exposure, parallel to the picture, whose origin is seen
/// at `pixel` at the case's time. \param depth metres along the view axis
[[nodiscard]] NodeDesc
crossingNode(const char* name, const Shot& shot, glm::vec2 pixel, float depth, glm::vec2 pixels);

/// A glider, nose along +X before `pose`. \param length metres
Index addGliderMesh(GltfWriter& writer, float length, const glm::mat4& pose);

/// rad/s that turn by `radians` in an exposure.
[[nodiscard]] float spinFor(float radians);

} // namespace shutter::generator
