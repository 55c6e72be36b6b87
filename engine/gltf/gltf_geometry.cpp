// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::gltf {

namespace {

using math::dvec2;
using math::dvec3;
using math::vec2;
using math::vec3;
using math::vec4;

bool isFinite(const vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Normal whose length is twice the area. In double precision, so that triangles of 1e-30 m and of
/// 1e30 m neither underflow nor overflow.
dvec3 crossOfTriangle(const std::vector<vec3>& positions, const uint32_t* triangle) {
    const dvec3 a(positions[triangle[0]]);
    const dvec3 b(positions[triangle[1]]);
    const dvec3 c(positions[triangle[2]]);
    return glm::cross(b - a, c - a);
}

/// Divides by the largest component first, because glm::normalize squares in the vector's own
/// precision and would lose tiny and huge vectors.
vec3 normalizeOr(const dvec3& v, const vec3& fallback) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0) || !std::isfinite(v.x + v.y + v.z))
        return fallback;
    return vec3(glm::normalize(v / largest));
}

constexpr vec3 kUp(0.0f, 1.0f, 0.0f);

template <class T>
std::vector<T> gather(const std::vector<T>& values, std::span<const uint32_t> sources) {
    if (values.empty())
        return {};
    std::vector<T> gathered;
    gathered.reserve(sources.size());
    for (const uint32_t source : sources)
        gathered.push_back(values[source]);
    return gathered;
}

struct Frame {
    dvec3 tangent{0.0};   ///< towards growing u, length in units of area
    dvec3 bitangent{0.0}; ///< towards shrinking v: +Y of a glTF normal map is up in the picture
};

/// Solves edge = du * tangent - dv * bitangent for both edges of the triangle. Only the sign of the
/// determinant is used, so the solution is weighted by the area in uv; it is rescaled to the
/// triangle's area in space, so that a stretched texture does not outvote its neighbours.
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
    // Relative to the sum: a tangent along the normal leaves only a rounding error.
    const bool usable = length > 1e-6 * glm::length(sum.tangent) && std::isfinite(length);
    tangent = usable ? tangent / length : anyOrthogonal(normal);
    const double handedness = glm::dot(glm::cross(normal, tangent), sum.bitangent);
    return vec4(vec3(tangent), usable && handedness < 0.0 ? -1.0f : 1.0f);
}

} // namespace

std::vector<uint32_t> triangulate(std::span<const uint32_t> indices, TriangleMode mode) {
    std::vector<uint32_t> triangles;
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        if (a != b && b != c && c != a)
            triangles.insert(triangles.end(), {a, b, c});
    };
    const size_t count = indices.size();
    if (mode == TriangleMode::List) {
        triangles.reserve(count);
        for (size_t i = 0; i + 2 < count; i += 3)
            add(indices[i], indices[i + 1], indices[i + 2]);
        return triangles;
    }
    triangles.reserve(count * 3);
    for (size_t i = 0; i + 2 < count; ++i) {
        if (mode == TriangleMode::Strip) {
            // Every second triangle of a strip is reversed, so that all face the same way.
            add(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
        } else {
            add(indices[i + 1], indices[i + 2], indices[0]);
        }
    }
    return triangles;
}

scene::Primitive
gatherVertices(const scene::Primitive& primitive, std::span<const uint32_t> sources) {
    scene::Primitive gathered;
    gathered.positions = gather(primitive.positions, sources);
    gathered.normals = gather(primitive.normals, sources);
    gathered.tangents = gather(primitive.tangents, sources);
    gathered.uv0 = gather(primitive.uv0, sources);
    gathered.uv1 = gather(primitive.uv1, sources);
    gathered.colors = gather(primitive.colors, sources);
    gathered.influenceCount = primitive.influenceCount;
    for (const uint32_t source : sources) {
        const size_t begin = size_t{source} * primitive.influenceCount;
        for (size_t i = begin; i < begin + primitive.influenceCount; ++i) {
            gathered.joints.push_back(primitive.joints[i]);
            gathered.weights.push_back(primitive.weights[i]);
        }
    }
    for (const scene::MorphTarget& target : primitive.morphTargets) {
        gathered.morphTargets.push_back(
            {gather(target.positions, sources),
             gather(target.normals, sources),
             gather(target.tangents, sources)}
        );
    }
    gathered.material = primitive.material;
    return gathered;
}

size_t removeNonFiniteTriangles(scene::Primitive& primitive) {
    const std::vector<uint32_t>& indices = primitive.indices;
    std::vector<uint32_t> kept;
    for (size_t i = 0; i < indices.size(); i += 3) {
        const bool finite = isFinite(primitive.positions[indices[i]]) &&
                            isFinite(primitive.positions[indices[i + 1]]) &&
                            isFinite(primitive.positions[indices[i + 2]]);
        if (finite)
            kept.insert(kept.end(), {indices[i], indices[i + 1], indices[i + 2]});
    }
    const size_t removed = (indices.size() - kept.size()) / 3;
    // Vertices that are not finite must be removed even where no triangle uses them.
    std::vector<uint32_t> newIndex(primitive.positions.size(), scene::kNone);
    std::vector<uint32_t> sources;
    for (uint32_t& index : kept) {
        if (newIndex[index] == scene::kNone) {
            newIndex[index] = uint32_t(sources.size());
            sources.push_back(index);
        }
        index = newIndex[index];
    }
    primitive = gatherVertices(primitive, sources);
    primitive.indices = std::move(kept);
    return removed;
}

void makeFlatNormals(scene::Primitive& primitive) {
    scene::Primitive flat = gatherVertices(primitive, primitive.indices);
    flat.indices.resize(primitive.indices.size());
    for (size_t i = 0; i < flat.indices.size(); ++i)
        flat.indices[i] = uint32_t(i);
    flat.normals.assign(flat.positions.size(), kUp);
    for (size_t i = 0; i < flat.indices.size(); i += 3) {
        const vec3 normal = normalizeOr(crossOfTriangle(flat.positions, &flat.indices[i]), kUp);
        flat.normals[i] = flat.normals[i + 1] = flat.normals[i + 2] = normal;
    }
    primitive = std::move(flat);
}

size_t repairNormals(scene::Primitive& primitive) {
    std::vector<bool> isBad(primitive.normals.size());
    size_t badCount = 0;
    for (size_t i = 0; i < primitive.normals.size(); ++i) {
        const vec3 unit = normalizeOr(dvec3(primitive.normals[i]), vec3(0.0f));
        isBad[i] = !(glm::dot(unit, unit) > 0.5f);
        badCount += isBad[i] ? 1 : 0;
        primitive.normals[i] = unit;
    }
    if (badCount == 0)
        return 0;
    std::vector<dvec3> sums(primitive.normals.size(), dvec3(0.0));
    for (size_t i = 0; i < primitive.indices.size(); i += 3) {
        const dvec3 cross = crossOfTriangle(primitive.positions, &primitive.indices[i]);
        for (size_t k = 0; k < 3; ++k)
            sums[primitive.indices[i + k]] += cross;
    }
    for (size_t i = 0; i < primitive.normals.size(); ++i) {
        if (isBad[i])
            primitive.normals[i] = normalizeOr(sums[i], kUp);
    }
    return badCount;
}

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
