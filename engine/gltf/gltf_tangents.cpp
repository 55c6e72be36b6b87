// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_geometry.h"

#include <cmath>

namespace shutter::gltf {

namespace {

using math::dvec2;
using math::dvec3;
using math::vec2;
using math::vec3;
using math::vec4;

struct Frame {
    dvec3 tangent{0.0};   ///< towards growing u, length in units of area
    dvec3 bitangent{0.0}; ///< towards shrinking v: +Y of a glTF normal map is up in the picture
};

/// Solves edge = du * tangent - dv * bitangent for both edges of the triangle. Without the division
/// by the determinant (only its sign is kept) the result is weighted by area in uv; scaled to the
/// triangle's own area, so that a stretched texture does not outvote its neighbours.
Frame computeTriangleFrame(
    const scene::Primitive& primitive, const std::vector<vec2>& uv, const uint32_t* triangle
) {
    const dvec3 origin(primitive.positions[triangle[0]]);
    const dvec3 edge1 = dvec3(primitive.positions[triangle[1]]) - origin;
    const dvec3 edge2 = dvec3(primitive.positions[triangle[2]]) - origin;
    const dvec2 delta1 = dvec2(uv[triangle[1]]) - dvec2(uv[triangle[0]]);
    const dvec2 delta2 = dvec2(uv[triangle[2]]) - dvec2(uv[triangle[0]]);
    const double determinant = delta1.x * delta2.y - delta2.x * delta1.y;
    if (determinant == 0.0 || !std::isfinite(determinant))
        return {};
    const double sign = determinant > 0.0 ? 1.0 : -1.0;
    const dvec3 tangent = (edge1 * delta2.y - edge2 * delta1.y) * sign;
    const dvec3 bitangent = (edge1 * delta2.x - edge2 * delta1.x) * sign;
    const double area = glm::length(glm::cross(edge1, edge2));
    const double tangentLength = glm::length(tangent);
    const double bitangentLength = glm::length(bitangent);
    if (!(tangentLength > 0.0) || !(bitangentLength > 0.0))
        return {};
    return {tangent * (area / tangentLength), bitangent * (area / bitangentLength)};
}

/// Any unit vector orthogonal to `normal`, for vertices whose texture coordinates give none.
dvec3 anyOrthogonal(const dvec3& normal) {
    const dvec3 axis = std::abs(normal.x) < 0.7 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
    return glm::normalize(glm::cross(normal, axis));
}

vec4 makeTangent(const vec3& unitNormal, const Frame& sum) {
    const dvec3 normal(unitNormal);
    dvec3 tangent = sum.tangent - normal * glm::dot(normal, sum.tangent);
    const double length = glm::length(tangent);
    // Relative to the sum: what is left of a tangent along the normal is rounding.
    const bool usable = length > 1e-6 * glm::length(sum.tangent) && std::isfinite(length);
    tangent = usable ? tangent / length : anyOrthogonal(normal);
    const double handedness = glm::dot(glm::cross(normal, tangent), sum.bitangent);
    return vec4(vec3(tangent), usable && handedness < 0.0 ? -1.0f : 1.0f);
}

} // namespace

void makeTangents(scene::Primitive& primitive, const std::vector<vec2>& uv) {
    std::vector<Frame> sums(primitive.positions.size());
    for (size_t i = 0; i < primitive.indices.size(); i += 3) {
        const uint32_t* triangle = &primitive.indices[i];
        const Frame frame = computeTriangleFrame(primitive, uv, triangle);
        for (size_t k = 0; k < 3; ++k) {
            sums[triangle[k]].tangent += frame.tangent;
            sums[triangle[k]].bitangent += frame.bitangent;
        }
    }
    primitive.tangents.resize(primitive.positions.size());
    for (size_t i = 0; i < primitive.tangents.size(); ++i) {
        primitive.tangents[i] = makeTangent(primitive.normals[i], sums[i]);
    }
}

bool areTangentsValid(const std::vector<vec4>& tangents) {
    for (const vec4& tangent : tangents) {
        const float squared = glm::dot(vec3(tangent), vec3(tangent));
        if (!std::isfinite(squared) || !(squared > 1e-12f) || std::isnan(tangent.w))
            return false;
    }
    return true;
}

void normalizeTangents(std::vector<vec4>& tangents) {
    for (vec4& tangent : tangents) {
        tangent = vec4(glm::normalize(vec3(tangent)), tangent.w < 0.0f ? -1.0f : 1.0f);
    }
}

} // namespace shutter::gltf
