// SPDX-License-Identifier: MIT
#include "assets/generator/mesh_shapes.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace shutter::generator {

namespace {

constexpr float kPi = glm::pi<float>();

} // namespace

void addTriangle(Shape& shape, size_t a, size_t b, size_t c) {
    for (const size_t index : {a, b, c}) {
        shape.indices.push_back(static_cast<uint32_t>(index));
    }
}

void addVertex(Shape& shape, glm::vec3 position, glm::vec3 normal, glm::vec2 uv) {
    shape.positions.push_back(position);
    shape.normals.push_back(normal);
    shape.uvs.push_back(uv);
}

void append(Shape& shape, const Shape& added, const glm::mat4& transform) {
    const size_t base = shape.positions.size();
    const glm::mat3 normalMatrix = glm::transpose(glm::inverse(glm::mat3(transform)));
    for (size_t i = 0; i < added.positions.size(); ++i) {
        addVertex(
            shape,
            glm::vec3(transform * glm::vec4(added.positions[i], 1.0f)),
            glm::normalize(normalMatrix * added.normals[i]),
            added.uvs[i]
        );
    }
    for (const uint32_t index : added.indices) {
        shape.indices.push_back(static_cast<uint32_t>(base) + index);
    }
    shape.joints.insert(shape.joints.end(), added.joints.begin(), added.joints.end());
    shape.weights.insert(shape.weights.end(), added.weights.begin(), added.weights.end());
    shape.slack.insert(shape.slack.end(), added.slack.begin(), added.slack.end());
}

void smoothNormals(Shape& shape) {
    std::vector<glm::vec3> sums(shape.positions.size(), glm::vec3(0.0f));
    for (size_t i = 0; i < shape.indices.size(); i += 3) {
        const uint32_t a = shape.indices[i];
        const uint32_t b = shape.indices[i + 1];
        const uint32_t c = shape.indices[i + 2];
        const glm::vec3 normal = glm::cross(
            shape.positions[b] - shape.positions[a], shape.positions[c] - shape.positions[a]
        );
        for (const uint32_t index : {a, b, c}) {
            sums[index] += normal;
        }
    }
    for (size_t i = 0; i < sums.size(); ++i) {
        // A pole of a lathe has one vertex that no triangle takes.
        if (sums[i] != glm::vec3(0.0f)) {
            shape.normals[i] = glm::normalize(sums[i]);
        }
    }
}

Shape withUvScale(Shape shape, glm::vec2 scale) {
    for (glm::vec2& uv : shape.uvs) {
        uv *= scale;
    }
    return shape;
}

std::vector<glm::vec2> smoothCurve(std::span<const glm::vec2> controls, int spanCount) {
    std::vector<glm::vec2> points;
    const int last = static_cast<int>(controls.size()) - 1;
    const auto control = [&](int i) {
        return controls[static_cast<size_t>(glm::clamp(i, 0, last))];
    };
    for (int i = 0; i <= spanCount; ++i) {
        const float along = static_cast<float>(i * last) / static_cast<float>(spanCount);
        const int k = glm::min(static_cast<int>(along), last - 1);
        const float t = along - static_cast<float>(k);
        const glm::vec2 p0 = control(k - 1);
        const glm::vec2 p1 = control(k);
        const glm::vec2 p2 = control(k + 1);
        const glm::vec2 p3 = control(k + 2);
        // Catmull and Rom 1974, tension 1/2.
        points.push_back(
            0.5f * (2.0f * p1 + t * (p2 - p0) + t * t * (2.0f * p0 - 5.0f * p1 + 4.0f * p2 - p3) +
                    t * t * t * (3.0f * p1 - p0 - 3.0f * p2 + p3))
        );
    }
    points.back() = controls.back(); // exact, since runs meet there and poles lie on the axis
    return points;
}

Shape lathe(std::span<const glm::vec2> run, int segmentCount) {
    Shape shape;
    const auto columnCount = static_cast<size_t>(segmentCount) + 1;
    const bool closed = glm::distance(run.front(), run.back()) < 1e-6f;
    for (size_t row = 0; row < run.size(); ++row) {
        glm::vec2 before = row > 0 ? run[row - 1] : run[row];
        glm::vec2 after = row + 1 < run.size() ? run[row + 1] : run[row];
        if (closed && (row == 0 || row + 1 == run.size())) {
            before = run[run.size() - 2];
            after = run[1];
        }
        const glm::vec2 tangent = glm::normalize(after - before);
        const float v = 1.0f - static_cast<float>(row) / static_cast<float>(run.size() - 1);
        for (size_t column = 0; column < columnCount; ++column) {
            const float u = static_cast<float>(column) / static_cast<float>(segmentCount);
            // The seam's two columns must meet exactly, so the last uses the first one's angle.
            const float angle = column + 1 == columnCount ? 0.0f : u * 2.0f * kPi;
            const glm::vec3 outwards(std::cos(angle), 0.0f, -std::sin(angle));
            addVertex(
                shape,
                outwards * run[row].x + glm::vec3(0.0f, run[row].y, 0.0f),
                outwards * tangent.y - glm::vec3(0.0f, tangent.x, 0.0f),
                glm::vec2(u, v)
            );
        }
    }
    for (size_t row = 0; row + 1 < run.size(); ++row) {
        for (size_t column = 0; column + 1 < columnCount; ++column) {
            const size_t a = row * columnCount + column;
            if (run[row].x > 0.0f) {
                addTriangle(shape, a, a + 1, a + columnCount + 1);
            }
            if (run[row + 1].x > 0.0f) {
                addTriangle(shape, a, a + columnCount + 1, a + columnCount);
            }
        }
    }
    return shape;
}

Shape cylinder(float radius, float height, int segmentCount) {
    const float half = height / 2.0f;
    const std::array<glm::vec2, 2> bottom = {glm::vec2(0.0f, -half), {radius, -half}};
    const std::array<glm::vec2, 2> side = {glm::vec2(radius, -half), {radius, half}};
    const std::array<glm::vec2, 2> top = {glm::vec2(radius, half), {0.0f, half}};
    Shape shape = lathe(bottom, segmentCount);
    append(shape, lathe(side, segmentCount));
    append(shape, lathe(top, segmentCount));
    return shape;
}

Shape sphere(float radius, int segmentCount, int ringCount) {
    std::vector<glm::vec2> run;
    for (int i = 0; i <= ringCount; ++i) {
        const float angle = kPi * (static_cast<float>(i) / static_cast<float>(ringCount) - 0.5f);
        const bool pole = i == 0 || i == ringCount;
        run.emplace_back(pole ? 0.0f : radius * std::cos(angle), radius * std::sin(angle));
    }
    Shape shape = lathe(run, segmentCount);
    for (size_t i = 0; i < shape.positions.size(); ++i) {
        shape.normals[i] = shape.positions[i] / radius; // exact at the poles as well
    }
    return shape;
}

Shape torus(float ringRadius, float tubeRadius, int segmentCount, int tubeSegmentCount) {
    std::vector<glm::vec2> run;
    for (int i = 0; i < tubeSegmentCount; ++i) {
        const float angle =
            2.0f * kPi * static_cast<float>(i) / static_cast<float>(tubeSegmentCount);
        run.emplace_back(ringRadius + tubeRadius * std::cos(angle), tubeRadius * std::sin(angle));
    }
    run.push_back(run.front());
    return lathe(run, segmentCount);
}

Wheel wheel(const WheelSize& size) {
    const glm::mat4 axisToZ = glm::rotate(glm::mat4(1.0f), kPi / 2.0f, glm::vec3(1, 0, 0));
    Wheel wheel;
    append(wheel.rim, torus(size.radius, size.rimRadius, 72, 10), axisToZ);
    append(wheel.hub, cylinder(size.hubRadius, size.hubRadius * 1.6f, 28), axisToZ);

    // Both ends stay inside hub and rim: no gap, no faces that coincide.
    const float first = size.hubRadius * 0.6f;
    const Shape spoke = cylinder(size.spokeRadius, size.radius - first, 8);
    for (int i = 0; i < size.spokeCount; ++i) {
        const float angle =
            2.0f * kPi * static_cast<float>(i) / static_cast<float>(size.spokeCount);
        const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0, 0, 1));
        const glm::vec3 middle(0.0f, (first + size.radius) / 2.0f, 0.0f);
        append(wheel.spokes, spoke, glm::translate(turn, middle));
    }
    return wheel;
}

} // namespace shutter::generator
