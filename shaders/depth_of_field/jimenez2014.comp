// SPDX-License-Identifier: MIT
// Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare", depth of
// field: scatter as you gather. Taps over the largest circle of confusion within reach count where
// their own circle comes here, by its density; depth separates them into a foreground at the
// neighbourhood's nearest depth and a background, and the first is composited over the second by
// the share of the disc that it covers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "depth_of_field/taps.glsl"

layout(binding = 3, rgba16f) uniform writeonly image2D uFiltered;

const float kDiagonalPx = 0.70710678f; // half a pixel's: a sharp point covers its pixel
const float kClassPx = 2.0f; // difference of radii over which the classes exchange

/// Weighted colours of the two classes; w is the sum of weights.
struct Classes {
    vec4 foreground;
    vec4 background;
};

/// \param distancePx of the tap from the pixel \param nearest radius of the neighbourhood's nearest depth
/// \param area in pixels that the tap represents, in units of an outer tap's
void add(inout Classes sums, Tap tap, float distancePx, float nearest, float area) {
    float radius = max(abs(tap.confusion), kDiagonalPx);
    float density = 1.0f / (kUnitDiscArea * radius * radius);
    float weight = area * density * saturate(radius - distancePx + 1.0f);
    float behind = smoothstep(0.0f, kClassPx, abs(tap.confusion - nearest));
    vec4 light = weight * vec4(tap.color, 1.0f);
    sums.background += behind * light;
    sums.foreground += (1.0f - behind) * light;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.sizePx)))) return;
    vec4 own = texelFetch(uColor, pixel, 0);
    vec2 reach = texelFetch(uReach, pixel / int(params.tilePx), 0).xy;
    // Nothing within reach is out of focus: the sharp colour, bit for bit.
    if (reach.x < kSharpPx) {
        imageStore(uFiltered, pixel, own);
        return;
    }
    vec2 centre = vec2(pixel) + 0.5f;
    float nearest = confusionRadius(params, reach.y);
    float tapArea = kUnitDiscArea * reach.x * reach.x / float(params.tapCount);
    float turn = findTurn(pixel);
    Classes sums = Classes(vec4(0.0f), vec4(0.0f));
    // The centre tap represents the pixel's area.
    add(sums, takeTap(centre), 0.0f, nearest, 1.0f / tapArea);
    for (uint i = 0u; i < params.tapCount; ++i) {
        vec2 offset = reach.x * discTap(i, params.tapCount, turn);
        add(sums, takeTap(centre + offset), length(offset), nearest, 1.0f);
    }
    vec4 front = sums.foreground;
    vec4 back = sums.background;
    vec3 foreground = front.w > 0.0f ? front.rgb / front.w : back.rgb / back.w;
    vec3 background = back.w > 0.0f ? back.rgb / back.w : foreground;
    vec3 color = mix(background, foreground, saturate(front.w * tapArea));
    imageStore(uFiltered, pixel, vec4(storableColor(color), own.a));
}
