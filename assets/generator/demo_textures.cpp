// SPDX-License-Identifier: MIT
// Small pictures, 256 pixels at most: the demos are drawn many times a second.
#include "assets/generator/axes.h"
#include "assets/generator/demo_scenes.h"
#include "assets/generator/scenes.h"

#include <cmath>

namespace shutter::generator {

Picture meadow() {
    return paint(256, 256, [](vec2 uv) {
        const bool dark = glm::fract(uv.x * 2.0f) < 0.5f;
        const vec3 tone = dark ? vec3(0.30f, 0.47f, 0.17f) : vec3(0.38f, 0.56f, 0.21f);
        const float tufts = fractalNoise(uv * 24.0f, {24, 24}, 301);
        return tone * (0.72f + 0.5f * tufts);
    });
}

Picture roadway() {
    return paint(128, 256, [](vec2 uv) {
        const float rough = fractalNoise(uv * vec2(24.0f, 48.0f), {24, 48}, 311);
        const vec3 asphalt = vec3(0.36f, 0.36f, 0.38f) * (0.82f + 0.32f * rough);
        const bool dash = std::abs(uv.x - 0.5f) < 0.017f && uv.y < 0.5f;
        const bool edge = std::abs(std::abs(uv.x - 0.5f) - 0.46f) < 0.015f;
        // Tyres have darkened two tracks.
        const float track = band(std::abs(uv.x - 0.5f), 0.17f, 0.06f);
        return dash || edge ? vec3(0.90f, 0.88f, 0.80f) : asphalt * (1.0f - 0.18f * track);
    });
}

Picture checkers(vec3 a, vec3 b) {
    return paint(64, 64, [=](vec2 uv) { return (uv.x < 0.5f) == (uv.y < 0.5f) ? a : b; });
}

Picture stripes(vec3 a, vec3 b) {
    return paint(128, 16, [=](vec2 uv) { return glm::fract(uv.x * 4.0f) < 0.5f ? a : b; });
}

Picture arrows(vec3 ground, vec3 arrow) {
    return paint(128, 32, [=](vec2 uv) {
        const float along = glm::fract(2.0f * uv.x + std::abs(uv.y - 0.5f));
        return along > 0.35f && along < 0.75f ? arrow : ground;
    });
}

Picture leaves(vec3 color) {
    return paint(64, 64, [=](vec2 uv) {
        const float tuft = fractalNoise(uv * 12.0f, {12, 12}, 351);
        return color * (0.55f + 0.75f * tuft);
    });
}

Picture rings(vec3 rim, vec3 fill) {
    return paint(16, 128, [=](vec2 uv) {
        const float radius = uv.y; // a cap's texture runs once around and from axis to rim
        if (radius < 0.22f)
            return vec3(0.96f, 0.80f, 0.20f);
        return static_cast<int>(radius * 4.6f) % 2 == 1 ? fill : rim;
    });
}

void addDemoSun(GltfWriter& writer, vec3 direction) {
    writer.addNode(
        {.name = "sun",
         .translation = {0.0f, 30.0f, 0.0f},
         .rotation = rotationTowards(direction),
         .light = writer.addLight(
             "sun", {.directional = true, .color = {1.0f, 0.96f, 0.88f}, .intensity = 3.2f}
         )}
    );
}

} // namespace shutter::generator
