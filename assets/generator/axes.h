// SPDX-License-Identifier: MIT
// The words in which the scenes are laid out: vectors, the world's axes, and moves along and about
// them. For sources of this folder only.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace shutter::generator {

using glm::mat4;
using glm::vec2;
using glm::vec3;

inline constexpr vec3 kX{1.0f, 0.0f, 0.0f}; ///< to the right
inline constexpr vec3 kY{0.0f, 1.0f, 0.0f}; ///< up
inline constexpr vec3 kZ{0.0f, 0.0f, 1.0f}; ///< towards the viewer

/// The transform that moves by `offset`, metres.
[[nodiscard]] inline mat4 moved(vec3 offset) {
    return glm::translate(mat4(1.0f), offset);
}

/// The rotation by `radians` about `axis` (unit), counter-clockwise seen from its tip.
[[nodiscard]] inline glm::quat turned(float radians, vec3 axis) {
    return glm::angleAxis(radians, axis);
}

} // namespace shutter::generator
