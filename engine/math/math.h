// SPDX-License-Identifier: MIT
// GLM, set up once for the whole engine. Conventions:
//   - right-handed world, metres, +Y up; a camera's forward axis is its own -Z (as in glTF);
//   - matrices are column-major and named by spaces: clipFromView * viewPoint = clipPoint;
//   - world transforms are double precision, GPU data is single precision and relative to the
//     camera, so that a scene far from the origin loses nothing;
//   - clip space is Vulkan's: x right, y down, depth reversed (1 at the near plane, 0 at infinity).
#pragma once

#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#endif

#include <glm/glm.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace shutter::math {

using glm::dmat3;
using glm::dmat4;
using glm::dquat;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::mat3;
using glm::mat4;
using glm::quat;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

} // namespace shutter::math
