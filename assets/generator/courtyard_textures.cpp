// SPDX-License-Identifier: MIT
#include "assets/generator/axes.h"
#include "assets/generator/textures.h"

#include <algorithm>
#include <cmath>

namespace shutter::generator {

using glm::mix;

Picture bricks() {
    return paint(1024, 1024, [](vec2 uv) {
        const int row = static_cast<int>(uv.y * 8.0f);
        const float shifted = uv.x * 4.0f + (row % 2 == 0 ? 0.0f : 0.5f);
        const int brick = static_cast<int>(shifted) % 4;
        const vec2 inside(glm::fract(shifted), glm::fract(uv.y * 8.0f));
        const float rough = fractalNoise(uv * 48.0f, {48, 48}, 81);
        if (inside.x < 0.05f || inside.y < 0.13f) {
            return vec3(0.76f, 0.73f, 0.67f) * (0.82f + 0.2f * rough);
        }
        const vec3 clay =
            mix(vec3(0.52f, 0.24f, 0.18f), vec3(0.78f, 0.46f, 0.33f), hash(brick, row, 83));
        return clay * (0.78f + 0.35f * rough);
    });
}

Picture paving() {
    return paint(1024, 1024, [](vec2 uv) {
        const int row = static_cast<int>(uv.y * 4.0f);
        const float shifted = uv.x * 4.0f + (row % 2 == 0 ? 0.0f : 0.5f);
        const int slab = static_cast<int>(shifted) % 4;
        const vec2 inside(glm::fract(shifted), glm::fract(uv.y * 4.0f));
        const float rough = fractalNoise(uv * 32.0f, {32, 32}, 91);
        if (inside.x < 0.035f || inside.y < 0.035f) {
            return vec3(0.30f, 0.31f, 0.27f) * (0.8f + 0.3f * rough);
        }
        const vec3 tone =
            mix(vec3(0.50f, 0.50f, 0.50f), vec3(0.76f, 0.72f, 0.65f), hash(slab, row, 93));
        return tone * (0.80f + 0.3f * rough);
    });
}

Picture crateBoards() {
    return paint(512, 512, [](vec2 uv) {
        const int board = static_cast<int>(uv.y * 5.0f);
        const float tone = 0.8f + 0.25f * hash(board, 0, 101);
        const vec3 pale = vec3(0.76f, 0.58f, 0.37f);
        vec3 color = pale * tone * (0.78f + 0.3f * grain(uv, 102));
        if (glm::fract(uv.y * 5.0f) < 0.06f) {
            color *= 0.35f;
        }
        const float diagonal = std::abs(uv.x - uv.y);
        const vec2 edge = glm::min(uv, 1.0f - uv);
        const float frame = std::min(edge.x, edge.y);
        if (frame < 0.11f || diagonal < 0.085f) {
            const bool rim =
                std::abs(frame - 0.11f) < 0.012f || (frame >= 0.11f && diagonal > 0.07f);
            color = vec3(0.55f, 0.37f, 0.21f) * (0.8f + 0.3f * grain({uv.y, uv.x}, 103));
            color *= rim ? 0.55f : 1.0f;
        }
        return color;
    });
}

Picture chevrons() {
    return paint(512, 512, [](vec2 uv) {
        const float stripe = glm::fract(uv.x * 2.0f + triangleWave(uv.y * 2.0f) * 0.5f);
        const vec3 color = stripe < 0.5f ? vec3(0.96f, 0.76f, 0.14f) : vec3(0.13f, 0.13f, 0.15f);
        return color * (0.90f + 0.12f * fractalNoise(uv * 24.0f, {24, 24}, 111));
    });
}

Picture beachBall() {
    return paint(512, 256, [](vec2 uv) {
        static const vec3 kPanels[] = {
            {0.93f, 0.92f, 0.88f},
            {0.86f, 0.20f, 0.16f},
            {0.93f, 0.92f, 0.88f},
            {0.14f, 0.42f, 0.72f},
            {0.93f, 0.92f, 0.88f},
            {0.95f, 0.72f, 0.15f}};
        if (uv.y < 0.07f || uv.y > 0.93f) {
            return vec3(0.14f, 0.42f, 0.72f);
        }
        if (band(uv.y, 0.5f, 0.03f) > 0.0f) {
            return vec3(0.10f, 0.13f, 0.20f);
        }
        return kPanels[static_cast<int>(uv.x * 6.0f) % 6];
    });
}

Picture polePaint() {
    return paint(64, 256, [](vec2 uv) {
        const bool red = glm::fract(uv.y * 2.0f) < 0.5f;
        const vec3 color = red ? vec3(0.80f, 0.14f, 0.12f) : vec3(0.92f, 0.91f, 0.87f);
        return color * (0.88f + 0.14f * fractalNoise(uv * vec2(4.0f, 32.0f), {4, 32}, 121));
    });
}

Picture rimPaint() {
    return paint(512, 32, [](vec2 uv) {
        const bool mark = glm::fract(uv.x * 4.0f) < 0.22f;
        const vec3 color = mark ? vec3(0.93f, 0.87f, 0.70f) : vec3(0.66f, 0.20f, 0.13f);
        return color * (0.86f + 0.16f * fractalNoise(uv * vec2(64.0f, 2.0f), {64, 2}, 125));
    });
}

Picture toyBlock() {
    return paint(512, 512, [](vec2 uv) {
        const vec2 p = uv - 0.5f;
        const float square = std::max(std::abs(p.x), std::abs(p.y));
        const float ring = glm::length(p);
        vec3 color(0.93f, 0.88f, 0.74f);
        color = mix(color, vec3(0.10f, 0.46f, 0.44f), square > 0.41f ? 1.0f : 0.0f);
        color = mix(color, vec3(0.90f, 0.46f, 0.12f), band(ring, 0.27f, 0.06f));
        const bool quarter = (p.x > 0.0f) == (p.y > 0.0f);
        color = mix(color, vec3(0.16f, 0.22f, 0.36f), ring < 0.16f && quarter ? 1.0f : 0.0f);
        return color * (0.94f + 0.08f * grain(uv, 131));
    });
}

Picture windowPanes() {
    return paint(256, 384, [](vec2 uv) {
        const vec2 pane = glm::fract(uv * vec2(2.0f, 3.0f));
        const vec2 edge = glm::min(pane, 1.0f - pane);
        if (edge.x < 0.07f || edge.y < 0.07f) {
            return vec3(0.90f, 0.89f, 0.84f);
        }
        const float sheen = band(glm::fract(uv.x * 1.3f + uv.y * 0.9f), 0.5f, 0.14f);
        return mix(
            vec3(0.16f, 0.24f, 0.31f), vec3(0.45f, 0.58f, 0.66f), 0.25f * uv.y + 0.5f * sheen
        );
    });
}

} // namespace shutter::generator
