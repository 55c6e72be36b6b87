// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <type_traits>
#include <vector>

namespace shutter::generator {

/// 8-bit sRGB, row 0 at the top.
struct Picture {
    int width = 0;  ///< pixels
    int height = 0; ///< pixels
    std::vector<uint8_t> rgb;
    std::vector<uint8_t> alpha{}; ///< linear, one per pixel; empty: opaque
};

/// Colour (sRGB-coded, [0, 1]; clamped) at a texture coordinate in [0, 1)^2, v downwards.
using Painter = std::function<glm::vec3(glm::vec2 uv)>;

/// Opacity, [0, 1], likewise.
using AlphaPainter = std::function<float(glm::vec2 uv)>;

/// Fills `alpha`.
void paintAlpha(Picture& picture, const AlphaPainter& painter);

/// Averages four evaluations a pixel, so that edges in `painter` need no filtering of their own.
[[nodiscard]] Picture paintAnew(int width, int height, const Painter& painter);

/// The same. A painter without captures always paints the same picture, at one size: it paints once
/// in a process, since scenes share textures and painting one of 1024 x 1024 takes half a second.
template <typename AnyPainter>
[[nodiscard]] Picture paint(int width, int height, const AnyPainter& painter) {
    if constexpr (std::is_empty_v<AnyPainter>) {
        static const Picture painted = paintAnew(width, height, painter);
        return painted;
    } else {
        return paintAnew(width, height, painter);
    }
}

/// The same bytes on every machine; a picture is encoded once in a process. Empty when the encoder
/// fails.
[[nodiscard]] std::vector<uint8_t> encodePng(const Picture& picture);

/// A value in [0, 1) that depends on the three integers only.
[[nodiscard]] float hash(int x, int y, int seed);

/// Smooth noise in [0, 1], one cell a unit, repeating after `period` cells in x and y.
[[nodiscard]] float noise(glm::vec2 p, glm::ivec2 period, int seed);

/// Three octaves of noise, [0, 1]; the period doubles with the frequency, so that it still tiles.
[[nodiscard]] float fractalNoise(glm::vec2 p, glm::ivec2 period, int seed);

/// 1 within `halfWidth` of `centre`, else 0; paint() smooths the edge.
[[nodiscard]] float band(float value, float centre, float halfWidth);

/// 0 at whole numbers, 1 halfway between, straight lines in between.
[[nodiscard]] float triangleWave(float value);

/// Wood fibres along u, [0, 1]; tiles.
[[nodiscard]] float grain(glm::vec2 uv, int seed);

} // namespace shutter::generator
