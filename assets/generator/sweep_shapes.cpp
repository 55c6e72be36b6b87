// SPDX-License-Identifier: MIT
#include "assets/generator/axes.h"
#include "assets/generator/mesh_shapes.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace shutter::generator {

namespace {

/// A flat end. \param side +1 faces along `tangent`, -1 against it
void addCap(
    Shape& shape, size_t firstOfRow, int segmentCount, vec3 centre, vec3 tangent, int side
) {
    const size_t middle = shape.positions.size();
    const vec3 normal = tangent * static_cast<float>(side);
    addVertex(shape, centre, normal, vec2(0.5f));
    for (size_t i = 0; i <= static_cast<size_t>(segmentCount); ++i) {
        const vec3 rim = shape.positions[firstOfRow + i];
        addVertex(shape, rim, normal, vec2(shape.uvs[firstOfRow + i].x, 0.0f));
    }
    for (size_t i = 1; i <= static_cast<size_t>(segmentCount); ++i) {
        if (side > 0) {
            addTriangle(shape, middle, middle + i, middle + i + 1);
        } else {
            addTriangle(shape, middle, middle + i + 1, middle + i);
        }
    }
}

constexpr int kCornerPoints = 4;
constexpr int kSectionPoints = 4 * kCornerPoints;

/// Point `index` of a section, counter-clockwise seen from +Z, beginning at the lower right corner.
vec3 sectionPoint(const LoftSection& section, float roundness, int index) {
    const vec2 half(section.halfWidth, 0.5f * (section.top - section.bottom));
    const float radius = roundness * std::min(half.x, half.y);
    const int corner = index / kCornerPoints;
    const float angle = glm::half_pi<float>() * (static_cast<float>(corner) - 1.0f +
                                                 static_cast<float>(index % kCornerPoints) /
                                                     static_cast<float>(kCornerPoints - 1));
    const vec2 side(
        corner == 0 || corner == 1 ? 1.0f : -1.0f, corner == 1 || corner == 2 ? 1.0f : -1.0f
    );
    const vec2 at = side * (half - radius) + radius * vec2(std::cos(angle), std::sin(angle));
    return {at.x, at.y + 0.5f * (section.top + section.bottom), section.z};
}

} // namespace

Shape loft(std::span<const LoftSection> sections, float roundness) {
    Shape shape;
    constexpr size_t kPoints = kSectionPoints;
    for (const LoftSection& section : sections)
        for (int i = 0; i < kSectionPoints; ++i)
            addVertex(
                shape,
                sectionPoint(section, roundness, i),
                kY,
                {static_cast<float>(i) / kSectionPoints, section.z}
            );
    for (size_t row = 0; row + 1 < sections.size(); ++row)
        for (size_t i = 0; i < kPoints; ++i) {
            const size_t next = (i + 1) % kPoints;
            const size_t a = row * kPoints;
            addTriangle(shape, a + i, a + next, a + kPoints + next);
            addTriangle(shape, a + i, a + kPoints + next, a + kPoints + i);
        }
    smoothNormals(shape);
    for (const bool isLast : {false, true}) {
        const LoftSection& section = isLast ? sections.back() : sections.front();
        const vec3 normal = isLast ? kZ : -kZ;
        const size_t middle = shape.positions.size();
        addVertex(shape, {0, 0.5f * (section.top + section.bottom), section.z}, normal, vec2(0.5f));
        for (int i = 0; i < kSectionPoints; ++i)
            addVertex(shape, sectionPoint(section, roundness, i), normal, vec2(0.5f));
        for (size_t i = 0; i < kPoints; ++i) {
            const size_t next = (i + 1) % kPoints;
            addTriangle(
                shape, middle, middle + 1 + (isLast ? i : next), middle + 1 + (isLast ? next : i)
            );
        }
    }
    return shape;
}

Shape tube(std::span<const vec3> path, std::span<const float> radii, int segmentCount) {
    Shape shape;
    const size_t last = path.size() - 1;
    const auto columnCount = static_cast<size_t>(segmentCount) + 1;
    const auto tangentAt = [&](size_t row) {
        return glm::normalize(path[std::min(row + 1, last)] - path[row > 0 ? row - 1 : 0]);
    };
    // Carried along the path without twist.
    const vec3 first = tangentAt(0);
    const vec3 helper = std::abs(first.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    vec3 side = glm::cross(first, helper);
    for (size_t row = 0; row <= last; ++row) {
        const vec3 tangent = tangentAt(row);
        side = glm::normalize(side - tangent * glm::dot(side, tangent));
        const vec3 up = glm::cross(tangent, side);
        const float v = 1.0f - static_cast<float>(row) / static_cast<float>(last);
        for (size_t column = 0; column < columnCount; ++column) {
            const float u = static_cast<float>(column) / static_cast<float>(segmentCount);
            const float angle = column + 1 == columnCount ? 0.0f : u * glm::two_pi<float>();
            const vec3 outwards = side * std::cos(angle) + up * std::sin(angle);
            addVertex(shape, path[row] + outwards * radii[row], outwards, {u, v});
        }
    }
    for (size_t row = 0; row < last; ++row) {
        for (size_t column = 0; column + 1 < columnCount; ++column) {
            const size_t a = row * columnCount + column;
            if (radii[row] > 0.0f) {
                addTriangle(shape, a, a + 1, a + columnCount + 1);
            }
            if (radii[row + 1] > 0.0f) {
                addTriangle(shape, a, a + columnCount + 1, a + columnCount);
            }
        }
    }
    if (radii.front() > 0.0f) {
        addCap(shape, 0, segmentCount, path.front(), first, -1);
    }
    if (radii[last] > 0.0f) {
        addCap(shape, last * columnCount, segmentCount, path.back(), tangentAt(last), 1);
    }
    return shape;
}

Shape tube(std::span<const vec3> path, float radius, int segmentCount) {
    const std::vector<float> radii(path.size(), radius);
    return tube(path, radii, segmentCount);
}

std::vector<vec3> helix(float radius, float height, float turnCount, int spanCount) {
    std::vector<vec3> points;
    for (int i = 0; i <= spanCount; ++i) {
        const float along = static_cast<float>(i) / static_cast<float>(spanCount);
        const float angle = along * turnCount * glm::two_pi<float>();
        points.emplace_back(
            radius * std::cos(angle), height * (along - 0.5f), -radius * std::sin(angle)
        );
    }
    return points;
}

Shape sheet(vec2 halfExtents, float tileMetres) {
    Shape shape;
    for (const vec2 side : {vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        const vec2 place = halfExtents * side;
        addVertex(shape, vec3(place, 0.0f), {0, 0, 1}, vec2(place.x, -place.y) / tileMetres + 0.5f);
    }
    addTriangle(shape, 0, 1, 2);
    addTriangle(shape, 0, 2, 3);
    return shape;
}

Shape cloth(vec2 halfExtents, glm::ivec2 cells, float tileMetres) {
    Shape shape;
    for (int row = 0; row <= cells.y; ++row)
        for (int column = 0; column <= cells.x; ++column) {
            const vec2 along = vec2(column, row) / vec2(cells);
            const vec2 place = halfExtents * (along * 2.0f - 1.0f);
            addVertex(shape, vec3(place, 0.0f), {0, 0, 1}, vec2(place.x, -place.y) / tileMetres);
            shape.slack.push_back(along.x);
        }
    const auto width = static_cast<size_t>(cells.x) + 1;
    for (size_t row = 0; row < static_cast<size_t>(cells.y); ++row)
        for (size_t column = 0; column + 1 < width; ++column) {
            const size_t a = row * width + column;
            addTriangle(shape, a, a + 1, a + width + 1);
            addTriangle(shape, a, a + width + 1, a + width);
        }
    return shape;
}

} // namespace shutter::generator
