// SPDX-License-Identifier: MIT
#include "engine/extract/poses.h"

#include "engine/math/transform.h"

#include <algorithm>
#include <cmath>

namespace shutter::extract {

using math::dmat4;
using math::dvec3;

bool isDrawable(const dmat4& matrix) {
    const double determinant = glm::determinant(math::dmat3(matrix));
    return math::isFinite(matrix) && std::isfinite(determinant) && determinant != 0.0;
}

dmat4 computeWorldFromView(const dmat4& worldFromCamera) {
    return math::removeScale(worldFromCamera);
}

shader::LightRow makeLight(const scene::Light& light, const dmat4& world, const dvec3& origin) {
    shader::LightRow row{};
    const dvec3 direction = -dvec3(world[2]);
    const double size = glm::length(direction);
    const dvec3 unit = size > 0.0 ? direction / size : dvec3(0.0, 0.0, -1.0);
    const float range = std::isfinite(light.range) ? light.range : 0.0f;
    row.positionRange = math::vec4(math::vec3(dvec3(world[3]) - origin), range);
    row.direction = math::vec4(math::vec3(unit), 0.0f);
    row.radiance = math::vec4(light.color * light.intensity, 0.0f);
    row.kind = static_cast<uint32_t>(light.kind);
    // KHR_lights_punctual, "Inner and Outer Cone Angles".
    const float outer = std::cos(light.outerConeAngle);
    row.spotScale = 1.0f / std::max(0.001f, std::cos(light.innerConeAngle) - outer);
    row.spotOffset = -outer * row.spotScale;
    return row;
}

} // namespace shutter::extract
