// SPDX-License-Identifier: MIT
// Motion of a raster pixel's surface over the exposure: a parabola of shutter time, and its
// encoding in an image of two words per pixel.
#ifndef SHUTTER_PIXEL_WAY_GLSL
#define SHUTTER_PIXEL_WAY_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Displacements from where the raster shows it, pixels.
struct PixelWay {
    vec2 open;  // at shutter open
    vec2 close; // at shutter close
    vec2 bend;  // of the middle, from halfway between the two
};

/// The first word where nothing is known: no packWay() has it.
SHUTTER_CONST uint kNoWay = 0xFFFFFFFFu;

SHUTTER_INLINE vec2 displacementAt(PixelWay way, float s) {
    return way.open + (way.close - way.open) * s + way.bend * (4.0f * s * (1.0f - s));
}

/// By a motion from open to close that is straight and even.
/// \param rasterTime shutter time of the raster
SHUTTER_INLINE PixelWay straightWay(vec2 motion, float rasterTime) {
    PixelWay way;
    way.open = motion * -rasterTime;
    way.close = motion * (1.0f - rasterTime);
    way.bend = vec2(0.0f);
    return way;
}

// Words: open x and y or close x and y, 11 bits each; bend x or y, 8 bits; two bits of the exponent of
// all. A step is 2^exponent / 64 pixels.
SHUTTER_CONST float kWaySteps = 64.0f; // per pixel, with the least exponent
SHUTTER_CONST float kMaxWaySteps = 1022.0f;
SHUTTER_CONST float kMaxBendSteps = 127.0f;
SHUTTER_CONST uint kMaxWayExponent = 15u;

/// The least exponent with which `steps` of the smallest size fit into `most`.
SHUTTER_INLINE uint wayExponent(float steps, float most) {
    // 2^exponent > steps / most, by the bits of a positive float.
    int exponent = int(floatBitsToUint(steps / most) >> 23u) - 126;
    return uint(clamp(exponent, 0, int(kMaxWayExponent)));
}

SHUTTER_INLINE float largestOf(vec2 v) { return max(abs(v.x), abs(v.y)); }

SHUTTER_INLINE uint packSteps(float value, float stepsPerPixel, float most) {
    return uint(int(floor(clamp(value * stepsPerPixel, -most, most) + 0.5f)) + int(most) + 1);
}

/// \param way finite
/// \return to a 32nd of a pixel up to 32 pixels, and in proportion beyond
SHUTTER_INLINE uvec2 packWay(PixelWay way) {
    float longest = max(largestOf(way.open), largestOf(way.close));
    uint exponent = wayExponent(longest * kWaySteps, kMaxWaySteps);
    exponent = max(exponent, wayExponent(largestOf(way.bend) * kWaySteps, kMaxBendSteps));
    float steps = kWaySteps * exp2(-float(exponent));
    uint x = packSteps(way.open.x, steps, kMaxWaySteps) |
             packSteps(way.open.y, steps, kMaxWaySteps) << 11u |
             packSteps(way.bend.x, steps, kMaxBendSteps) << 22u | (exponent & 3u) << 30u;
    uint y = packSteps(way.close.x, steps, kMaxWaySteps) |
             packSteps(way.close.y, steps, kMaxWaySteps) << 11u |
             packSteps(way.bend.y, steps, kMaxBendSteps) << 22u | (exponent >> 2u) << 30u;
    return uvec2(x, y);
}

SHUTTER_INLINE vec2 unpackSteps(uint word) {
    return vec2(float(word & 0x7FFu), float((word >> 11u) & 0x7FFu)) - (kMaxWaySteps + 1.0f);
}

SHUTTER_INLINE float unpackBend(uint word) {
    return float((word >> 22u) & 0xFFu) - (kMaxBendSteps + 1.0f);
}

SHUTTER_INLINE PixelWay unpackWay(uvec2 words) {
    float step_ = exp2(float(words.x >> 30u | (words.y >> 30u) << 2u)) / kWaySteps;
    PixelWay way;
    way.open = unpackSteps(words.x) * step_;
    way.close = unpackSteps(words.y) * step_;
    way.bend = vec2(unpackBend(words.x), unpackBend(words.y)) * step_;
    return way;
}

SHUTTER_SHADER_END

#endif
