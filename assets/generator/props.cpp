// SPDX-License-Identifier: MIT
#include "assets/generator/props.h"

#include "assets/generator/axes.h"
#include "assets/generator/picture.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace shutter::generator {

namespace {

/// A rod from one point to another.
void addRod(Shape& shape, vec3 from, vec3 to, float radius, int segmentCount) {
    const std::array path = {from, to};
    append(shape, tube(path, radius, segmentCount));
}

} // namespace

Glider glider(float length) {
    const std::array<vec2, 8> outline = {
        vec2(0.0f, -0.50f),
        {0.016f, -0.495f},
        {0.030f, -0.30f},
        {0.060f, 0.05f},
        {0.075f, 0.25f},
        {0.066f, 0.40f},
        {0.035f, 0.48f},
        {0.0f, 0.50f}};
    std::vector<vec2> run = smoothCurve(outline, 28);
    for (vec2& point : run) {
        point = glm::max(point, vec2(0.0f, -1.0f)) * length;
    }
    Glider result;
    append(result.body, lathe(run, 28), glm::rotate(mat4(1.0f), -glm::half_pi<float>(), kZ));
    const auto addPlane = [&](vec3 at, vec3 half, float lean) {
        const mat4 place = glm::rotate(moved(at * length), lean, kX);
        append(result.wings, roundedBox(half * length, 0.007f * length, 2, 0.35f * length), place);
    };
    for (const float side : {-1.0f, 1.0f}) {
        // A little dihedral; the two halves meet inside the body.
        addPlane({0.13f, 0.05f, side * 0.235f}, {0.085f, 0.011f, 0.225f}, side * -0.08f);
    }
    addPlane({-0.42f, 0.015f, 0.0f}, {0.05f, 0.009f, 0.16f}, 0.0f);
    addPlane({-0.435f, 0.085f, 0.0f}, {0.05f, 0.085f, 0.010f}, 0.0f);
    return result;
}

Shape jug() {
    constexpr std::array<vec2, 8> kOutside = {
        vec2(0.085f, 0.000f),
        {0.085f, 0.012f},
        {0.125f, 0.100f},
        {0.150f, 0.200f},
        {0.130f, 0.310f},
        {0.080f, 0.400f},
        {0.075f, 0.460f},
        {0.105f, 0.520f}};
    constexpr std::array<vec2, 5> kInside = {
        vec2(0.105f, 0.520f), {0.066f, 0.460f}, {0.070f, 0.400f}, {0.110f, 0.300f}, {0.0f, 0.05f}};
    constexpr std::array<vec2, 2> kFoot = {vec2(0.0f, 0.0f), kOutside.front()};
    constexpr int kSegments = 48;
    const mat4 toPivot = moved({0.0f, -0.26f, 0.0f});
    Shape shape;
    append(shape, lathe(smoothCurve(kOutside, 24), kSegments), toPivot);
    append(shape, lathe(smoothCurve(kInside, 10), kSegments), toPivot);
    append(shape, lathe(kFoot, kSegments), toPivot);
    constexpr std::array<vec2, 6> kHandle = {
        vec2(0.070f, 0.445f),
        {0.160f, 0.470f},
        {0.215f, 0.410f},
        {0.220f, 0.310f},
        {0.190f, 0.230f},
        {0.130f, 0.190f}};
    std::vector<vec3> path;
    for (const vec2 point : smoothCurve(kHandle, 20)) {
        path.emplace_back(point, 0.0f);
    }
    append(shape, tube(path, 0.019f, 14), toPivot);
    return shape;
}

Shape pinwheel(float radius, int bladeCount) {
    Shape shape = cylinder(radius * 0.10f, radius * 0.14f, 24);
    Shape turned;
    append(turned, shape, glm::rotate(mat4(1.0f), glm::half_pi<float>(), kX));
    const Shape blade = roundedBox(
        {radius * 0.17f, radius * 0.46f, radius * 0.012f}, radius * 0.011f, 2, radius * 0.4f
    );
    for (int i = 0; i < bladeCount; ++i) {
        const float angle =
            glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(bladeCount);
        const mat4 spoke = glm::rotate(mat4(1.0f), angle, kZ);
        const mat4 place = glm::translate(spoke, vec3(0.0f, radius * 0.54f, 0.0f));
        append(turned, blade, glm::rotate(place, 0.45f, kY));
    }
    return turned;
}

Shape coilWithRing() {
    Shape shape = tube(helix(0.17f, 0.42f, 4.0f, 160), 0.022f, 14);
    // The ring is upright, reaches out of the coil and hangs in two of its turns.
    const mat4 upright = glm::rotate(moved({0.16f, 0.02f, 0.0f}), glm::half_pi<float>(), kX);
    append(shape, torus(0.14f, 0.018f, 56, 12), upright);
    return shape;
}

Shape wireGate(vec2 halfExtents, float wireRadius, glm::ivec2 wireCount) {
    constexpr float kBar = 0.014f;
    Shape shape;
    for (const float side : {-1.0f, 1.0f}) {
        append(
            shape,
            roundedBox({halfExtents.x + kBar, kBar, kBar}, 0.004f, 1, 0.3f),
            moved({0.0f, side * halfExtents.y, 0.0f})
        );
        append(
            shape,
            roundedBox({kBar, halfExtents.y, kBar * 0.9f}, 0.004f, 1, 0.3f),
            moved({side * halfExtents.x, 0.0f, 0.0f})
        );
    }
    // Upright wires pass before the level ones.
    const auto spread = [](int i, int count) {
        return 2.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(count) - 1.0f;
    };
    for (int i = 0; i < wireCount.x; ++i) {
        const float x = halfExtents.x * spread(i, wireCount.x);
        addRod(
            shape, {x, -halfExtents.y, wireRadius}, {x, halfExtents.y, wireRadius}, wireRadius, 6
        );
    }
    for (int i = 0; i < wireCount.y; ++i) {
        const float y = halfExtents.y * spread(i, wireCount.y);
        addRod(
            shape, {-halfExtents.x, y, -wireRadius}, {halfExtents.x, y, -wireRadius}, wireRadius, 6
        );
    }
    return shape;
}

Shape grassClump(int bladeCount, float height, int seed) {
    constexpr int kSpans = 4;
    Shape shape;
    for (int i = 0; i < bladeCount; ++i) {
        const float angle = glm::two_pi<float>() * hash(i, 0, seed);
        const vec3 outwards(std::cos(angle), 0.0f, std::sin(angle));
        const float reach = height * (0.15f + 0.45f * hash(i, 1, seed));
        const float top = height * (0.65f + 0.35f * hash(i, 2, seed));
        const float thick = 0.0025f + 0.0035f * hash(i, 3, seed);
        const vec3 root = outwards * (0.07f * hash(i, 4, seed));
        std::vector<vec3> path;
        std::vector<float> radii;
        for (int k = 0; k <= kSpans; ++k) {
            const float t = static_cast<float>(k) / kSpans;
            path.push_back(root + outwards * (reach * t * t) + kY * (top * (t - 0.25f * t * t)));
            radii.push_back(k == kSpans ? 0.0f : thick * (1.0f - 0.7f * t));
        }
        append(shape, tube(path, radii, 5));
    }
    return shape;
}

HighWheeler highWheeler() {
    HighWheeler result;
    result.largeRadius = 0.60f;
    result.smallRadius = 0.19f;
    result.rimRadius = 0.022f;
    result.smallWheelAt = {-0.86f, result.smallRadius - result.largeRadius, 0.0f};
    const float top = result.largeRadius + 0.075f;
    // The backbone follows the large wheel's rim, then leaves it for the small one's fork.
    std::vector<vec2> spine = {{0.0f, top}};
    for (const float angle : {110.0f, 130.0f, 150.0f, 168.0f}) {
        spine.push_back(top * vec2(std::cos(glm::radians(angle)), std::sin(glm::radians(angle))));
    }
    spine.push_back(vec2(result.smallWheelAt) + vec2(-0.02f, result.smallRadius + 0.05f));
    std::vector<vec3> path;
    for (const vec2 point : smoothCurve(spine, 30)) {
        path.emplace_back(point, 0.0f);
    }
    append(result.frame, tube(path, 0.021f, 12));
    for (const float side : {-1.0f, 1.0f}) {
        addRod(result.frame, {0, top, 0}, {0, 0, side * 0.075f}, 0.013f, 10);
        addRod(result.frame, path.back(), result.smallWheelAt + kZ * (side * 0.05f), 0.011f, 10);
    }
    addRod(result.frame, {0.0f, top, 0.0f}, {0.03f, top + 0.13f, 0.0f}, 0.016f, 12);
    addRod(result.frame, {0.03f, top + 0.13f, -0.26f}, {0.03f, top + 0.13f, 0.26f}, 0.012f, 10);
    addRod(result.frame, {0, 0, -0.12f}, {0, 0, 0.12f}, 0.016f, 10);
    append(
        result.saddle,
        roundedBox({0.13f, 0.028f, 0.075f}, 0.025f, 3, 0.2f),
        moved({-0.16f, top + 0.045f, 0.0f})
    );
    return result;
}

} // namespace shutter::generator
