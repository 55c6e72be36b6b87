// SPDX-License-Identifier: MIT
#include "assets/generator/axes.h"
#include "assets/generator/textures.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace shutter::generator {

using glm::mix;

namespace {

constexpr float kTau = glm::two_pi<float>();

} // namespace

Picture wood(vec3 dark, vec3 light) {
    return paint(256, 256, [=](vec2 uv) {
        const float rings = fractalNoise(uv * vec2(2.0f, 12.0f), {2, 12}, 5);
        return mix(dark, light, glm::clamp(0.6f * grain(uv, 1) + 0.6f * rings - 0.1f, 0.0f, 1.0f));
    });
}

Picture planks() {
    constexpr int kRows = 8;
    return paint(1024, 1024, [](vec2 uv) {
        const int row = static_cast<int>(uv.y * kRows);
        const float across = glm::fract(uv.y * kRows);
        // Two boards a row, each row shifted, and every board of another tree.
        const float shifted = uv.x * 2.0f + hash(row, 0, 7) * 2.0f;
        const int board = static_cast<int>(shifted) % 2;
        const float along = glm::fract(shifted);
        const float tone = hash(row, board, 11);
        const vec3 light = mix(vec3(0.80f, 0.60f, 0.40f), vec3(0.60f, 0.40f, 0.24f), tone);
        const float fibre = grain(uv + vec2(tone, 0.0f), 3);
        vec3 color = light * mix(0.72f, 1.08f, fibre);
        if (across < 0.045f || along < 0.006f) {
            color *= 0.35f;
        }
        return color;
    });
}

Picture stone(vec3 color) {
    return paint(256, 256, [=](vec2 uv) {
        const float coarse = fractalNoise(uv * 8.0f, {8, 8}, 21);
        const float fine = noise(uv * 64.0f, {64, 64}, 22);
        return color * (0.70f + 0.35f * coarse + 0.12f * fine);
    });
}

Picture wovenCheck() {
    return paint(512, 512, [](vec2 uv) {
        const vec2 check = glm::fract(uv * 4.0f);
        vec3 color(0.93f, 0.91f, 0.86f);
        const vec3 blue(0.58f, 0.66f, 0.74f);
        color = mix(color, blue, 0.50f * band(check.x, 0.30f, 0.17f));
        color = mix(color, blue, 0.50f * band(check.y, 0.30f, 0.17f));
        const vec3 rust(0.72f, 0.44f, 0.33f);
        color = mix(color, rust, 0.75f * band(check.x, 0.78f, 0.045f));
        color = mix(color, rust, 0.75f * band(check.y, 0.78f, 0.045f));
        const float weave = std::sin(uv.x * kTau * 64.0f) * std::sin(uv.y * kTau * 64.0f);
        return color * (0.97f + 0.03f * weave);
    });
}

Picture pinkLattice() {
    return paint(512, 512, [](vec2 uv) {
        const vec2 cell = glm::fract(uv * 8.0f) - 0.5f;
        const float diamond = std::abs(cell.x) + std::abs(cell.y);
        vec3 color(0.92f, 0.42f, 0.56f);
        color = mix(color, vec3(0.97f, 0.66f, 0.74f), band(diamond, 0.5f, 0.085f));
        color = mix(color, vec3(0.80f, 0.26f, 0.42f), diamond < 0.22f ? 1.0f : 0.0f);
        const vec2 edge = glm::min(uv, 1.0f - uv);
        if (std::min(edge.x, edge.y) < 0.035f) {
            color = vec3(0.80f, 0.24f, 0.42f); // the piping
        }
        return color * (0.95f + 0.05f * noise(uv * 96.0f, {96, 96}, 31));
    });
}

Picture blueHerringbone() {
    return paint(512, 512, [](vec2 uv) {
        const float zigzag = uv.y * 12.0f + 0.9f * triangleWave(uv.x * 6.0f);
        const float line = glm::fract(zigzag) < 0.5f ? 1.0f : 0.0f;
        return mix(vec3(0.20f, 0.36f, 0.47f), vec3(0.80f, 0.83f, 0.79f), line) *
               (0.95f + 0.05f * noise(uv * 96.0f, {96, 96}, 33));
    });
}

Picture wallpaper() {
    return paint(512, 512, [](vec2 uv) {
        const vec2 p = uv * 2.0f;
        // Two families of waves that touch make the trellis; a leaf sits in each opening.
        const float wave = 0.25f * std::cos(p.y * kTau);
        const float left = std::abs(glm::fract(p.x - wave) - 0.5f);
        const float right = std::abs(glm::fract(p.x + wave) - 0.5f);
        vec3 color(0.56f, 0.66f, 0.60f);
        color *= 0.97f + 0.05f * noise(uv * 32.0f, {32, 32}, 41);
        if (std::min(left, right) < 0.055f) {
            color = vec3(0.86f, 0.87f, 0.78f);
        }
        for (const vec2 middle : {vec2(0.5f, 0.5f), vec2(0.0f, 0.0f)}) {
            const vec2 d = glm::fract(p - middle + 0.5f) - 0.5f;
            const float leaf = std::abs(d.x) * 1.9f + d.y * d.y * 6.0f;
            if (leaf < 0.30f) {
                color = leaf < 0.12f ? vec3(0.90f, 0.76f, 0.45f) : vec3(0.36f, 0.48f, 0.44f);
            }
        }
        return color;
    });
}

Picture redGlaze() {
    return paint(1024, 512, [](vec2 uv) {
        // Fired glaze: darker where it pools, streaked downwards.
        const float streak = fractalNoise(uv * vec2(48.0f, 4.0f), {48, 4}, 51);
        vec3 color = mix(vec3(0.58f, 0.04f, 0.05f), vec3(0.86f, 0.13f, 0.09f), streak);
        const vec3 cream(0.95f, 0.88f, 0.72f);
        const vec3 dark(0.22f, 0.03f, 0.05f);
        for (const float ring : {0.12f, 0.235f, 0.36f, 0.60f, 0.90f}) {
            color = mix(color, cream, band(uv.y, ring, 0.011f));
        }
        const float zigzag = 0.455f + 0.05f * (triangleWave(uv.x * 18.0f) - 0.5f) * 1.6f;
        color = mix(color, cream, band(uv.y, zigzag, 0.014f));
        color = mix(color, dark, band(uv.y, 0.385f, 0.009f));
        color = mix(color, dark, band(uv.y, 0.575f, 0.009f));
        const vec2 dot((glm::fract(uv.x * 20.0f) - 0.5f) * 0.8f, (uv.y - 0.70f) * 11.0f);
        color = mix(color, cream, glm::length(dot) < 0.26f ? 1.0f : 0.0f);
        color = mix(color, dark, band(uv.y, 0.79f, 0.012f));
        color = mix(color, dark, band(uv.y, 0.178f, 0.012f));
        return color;
    });
}

Picture rug() {
    return paint(512, 512, [](vec2 uv) {
        const float step = std::floor(uv.y * 24.0f) / 24.0f;
        const float stepped = glm::fract(uv.x * 6.0f + triangleWave(step * 3.0f));
        vec3 color(0.80f, 0.74f, 0.63f);
        if (stepped < 0.28f) {
            color = vec3(0.22f, 0.34f, 0.42f);
        } else if (stepped > 0.52f && stepped < 0.66f) {
            color = vec3(0.70f, 0.33f, 0.24f);
        }
        return color * (0.88f + 0.14f * noise(uv * 128.0f, {128, 128}, 61));
    });
}

Picture landscape() {
    return paint(512, 384, [](vec2 uv) {
        vec3 color = mix(vec3(0.20f, 0.36f, 0.55f), vec3(0.97f, 0.75f, 0.52f), uv.y * 1.5f);
        const vec2 sun = (uv - vec2(0.64f, 0.40f)) * vec2(4.0f / 3.0f, 1.0f);
        color = mix(color, vec3(0.99f, 0.93f, 0.74f), glm::length(sun) < 0.10f ? 1.0f : 0.0f);
        for (int range = 0; range < 4; ++range) {
            const auto r = static_cast<float>(range);
            const float ridge =
                0.48f + 0.12f * r +
                (0.16f - 0.03f * r) * (0.5f - noise({uv.x * (4.0f + r), r}, {64, 64}, 71));
            if (uv.y > ridge) {
                color = mix(vec3(0.55f, 0.50f, 0.55f), vec3(0.10f, 0.22f, 0.22f), r / 3.0f);
            }
        }
        return color;
    });
}

} // namespace shutter::generator
