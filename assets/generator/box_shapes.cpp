// SPDX-License-Identifier: MIT
#include "assets/generator/mesh_shapes.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace shutter::generator {

namespace {

constexpr float kHalfTurn = glm::pi<float>();

/// The six faces of a box: outward axis and the axes of u (right) and v (up) seen from outside.
struct Face {
    glm::vec3 out;
    glm::vec3 right;
    glm::vec3 up;
};

constexpr std::array<Face, 6> kFaces = {{
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
    {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
}};

/// One face of a rounded box. Each grid line has a direction towards the sphere that rounds the
/// corner and a side (-1 or +1) that says which corner's sphere; the two middle lines share the
/// direction 0 and span the flat part.
void addRoundedFace(
    Shape& shape, const Face& face, glm::vec3 halfExtents, float radius, int steps, float tileMetres
) {
    const auto base = shape.positions.size();
    const int lineCount = 2 * steps + 2;
    const glm::vec3 inner = halfExtents - radius;
    const float innerRight = glm::dot(glm::abs(face.right), inner);
    const float innerUp = glm::dot(glm::abs(face.up), inner);
    const auto angleOf = [&](int line) {
        const int step = line <= steps ? line - steps : line - steps - 1;
        return static_cast<float>(step) / static_cast<float>(steps) * kHalfTurn / 4.0f;
    };
    const auto sideOf = [&](int line) { return line <= steps ? -1.0f : 1.0f; };
    for (int row = 0; row < lineCount; ++row) {
        for (int column = 0; column < lineCount; ++column) {
            const glm::vec3 normal = glm::normalize(
                face.out + face.right * std::tan(angleOf(column)) + face.up * std::tan(angleOf(row))
            );
            const glm::vec3 corner = face.out * glm::dot(glm::abs(face.out), inner) +
                                     face.right * (sideOf(column) * innerRight) +
                                     face.up * (sideOf(row) * innerUp);
            const glm::vec2 along(
                sideOf(column) * innerRight + radius * angleOf(column),
                sideOf(row) * innerUp + radius * angleOf(row)
            );
            addVertex(
                shape,
                corner + normal * radius,
                normal,
                glm::vec2(along.x, -along.y) / tileMetres + 0.5f
            );
        }
    }
    const auto width = static_cast<size_t>(lineCount);
    for (size_t row = 0; row + 1 < width; ++row) {
        for (size_t column = 0; column + 1 < width; ++column) {
            const size_t a = base + row * width + column;
            addTriangle(shape, a, a + 1, a + width + 1);
            addTriangle(shape, a, a + width + 1, a + width);
        }
    }
}

} // namespace

Shape box(glm::vec3 halfExtents, float tileMetres) {
    Shape shape;
    for (const Face& face : kFaces) {
        const size_t base = shape.positions.size();
        const glm::vec3 right = face.right * glm::dot(glm::abs(face.right), halfExtents);
        const glm::vec3 up = face.up * glm::dot(glm::abs(face.up), halfExtents);
        const glm::vec3 centre = face.out * glm::dot(glm::abs(face.out), halfExtents);
        for (const glm::vec2 side : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
            const glm::vec2 along(glm::length(right) * side.x, -glm::length(up) * side.y);
            addVertex(
                shape, centre + right * side.x + up * side.y, face.out, along / tileMetres + 0.5f
            );
        }
        addTriangle(shape, base, base + 1, base + 2);
        addTriangle(shape, base, base + 2, base + 3);
    }
    return shape;
}

Shape roundedBox(glm::vec3 halfExtents, float radius, int cornerSteps, float tileMetres) {
    Shape shape;
    for (const Face& face : kFaces) {
        addRoundedFace(shape, face, halfExtents, radius, cornerSteps, tileMetres);
    }
    return shape;
}

Shape pillow(glm::vec3 halfExtents, float pinch, int gridSize) {
    Shape sheet;
    const auto width = static_cast<size_t>(gridSize) + 1;
    const auto angleOf = [&](size_t line) {
        return kHalfTurn * (static_cast<float>(line) / static_cast<float>(gridSize) - 0.5f);
    };
    for (size_t row = 0; row < width; ++row) {
        for (size_t column = 0; column < width; ++column) {
            const glm::vec2 p(std::sin(angleOf(column)), std::sin(angleOf(row)));
            const bool border = row == 0 || column == 0 || row + 1 == width || column + 1 == width;
            const float bulge = border ? 0.0f : std::cos(angleOf(column)) * std::cos(angleOf(row));
            const glm::vec2 outline = p * (1.0f - pinch * (1.0f - glm::vec2(p.y * p.y, p.x * p.x)));
            addVertex(
                sheet,
                halfExtents * glm::vec3(outline, bulge),
                glm::vec3(0.0f),
                glm::vec2(0.5f + 0.5f * p.x, 0.5f - 0.5f * p.y)
            );
        }
    }
    for (size_t row = 0; row + 1 < width; ++row) {
        for (size_t column = 0; column + 1 < width; ++column) {
            const size_t a = row * width + column;
            // Diagonals lead to the middle: the other one would cut the corners off flat, and there
            // both sheets would lie in one plane.
            if ((row < width / 2) == (column < width / 2)) {
                addTriangle(sheet, a, a + 1, a + width + 1);
                addTriangle(sheet, a, a + width + 1, a + width);
            } else {
                addTriangle(sheet, a, a + 1, a + width);
                addTriangle(sheet, a + 1, a + width + 1, a + width);
            }
        }
    }
    smoothNormals(sheet);
    Shape shape = sheet;
    append(shape, sheet, glm::rotate(glm::mat4(1.0f), kHalfTurn, glm::vec3(0.0f, 1.0f, 0.0f)));
    return shape;
}

} // namespace shutter::generator
