// SPDX-License-Identifier: MIT
// A near field over a far field (Sousa 2013, "CryENGINE 3 Graphics Gems"; Abadie 2018, "A Life of a
// Bokeh"). The near field gathers over the largest circle of confusion within reach and has the
// coverage of the circles of its taps; the far field gathers over the pixel's own circle, without
// leaks from surfaces in focus. Behind a pixel of the near field lies the mean of the taps that are
// not near.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "depth_of_field/taps.glsl"

/// 1 within a circle, down to 0 over its rim of one pixel.
float coverRim(float radius, float distancePx) { return saturate(radius - distancePx + 0.5f); }

struct NearField {
    vec4 light;    // weighted colours, sum of weights
    vec4 behind;   // colours of the taps that are not near, and their number
    float covered; // share of the pixel
};

/// Light of a tap of the near field. \param distancePx from the pixel
vec4 spreadNear(Tap tap, float distancePx) {
    float radius = -tap.confusion;
    return coverRim(radius, distancePx) / (radius * radius) * vec4(tap.color, 1.0f);
}

NearField gatherNear(vec2 centre, float reach, float turn) {
    NearField near = NearField(vec4(0.0f), vec4(0.0f), 0.0f);
    // The centre tap represents the pixel's area, which widely spaced taps miss, along with circles
    // little larger than it.
    Tap own = takeTap(centre);
    float tapArea = kUnitDiscArea * reach * reach / float(params.tapCount);
    float missed = saturate(1.0f - 1.0f / tapArea);
    if (own.confusion < -kSharpPx) near.light = missed / tapArea * spreadNear(own, 0.0f);
    for (uint i = 0u; i < params.tapCount; ++i) {
        vec2 offset = reach * discTap(i, params.tapCount, turn);
        Tap tap = takeTap(centre + offset);
        if (tap.confusion >= -kSharpPx) {
            near.behind += vec4(tap.color, 1.0f);
            continue;
        }
        near.light += spreadNear(tap, length(offset));
    }
    // A tap represents the disc's area divided by their number, and its light the area of its
    // circle.
    near.covered = saturate(near.light.w * tapArea / kUnitDiscArea);
    return near;
}

/// \param radius the pixel's own, 0 or more
vec4 gatherFar(vec2 centre, float radius, float turn) {
    vec4 light = vec4(0.0f);
    for (uint i = 0u; i < params.tapCount; ++i) {
        vec2 offset = radius * discTap(i, params.tapCount, turn);
        Tap tap = takeTap(centre + offset);
        if (tap.confusion < -kSharpPx) continue;
        float spread = min(max(tap.confusion, 0.0f), radius);
        light += coverRim(spread, length(offset)) * vec4(tap.color, 1.0f);
    }
    return light;
}

/// The background of the near field. \param radius the pixel's own, signed
vec3 findFar(vec2 centre, float radius, float turn, NearField near, vec3 own) {
    if (radius < -kSharpPx)
        return near.behind.w > 0.0f ? near.behind.rgb / near.behind.w : near.light.rgb / near.light.w;
    if (radius <= kSharpPx) return own; // all taps lie in the pixel
    vec4 light = gatherFar(centre, radius, turn);
    return light.w > 1.0e-6f ? light.rgb / light.w : own;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.sizePx)))) return;
    vec4 own = texelFetch(uColor, pixel, 0);
    float reach = texelFetch(uReach, pixel / int(params.tilePx), 0).x;
    // Nothing within reach is out of focus: the sharp colour, bit for bit.
    if (reach < kSharpPx) {
        imageStore(uFiltered, pixel, own);
        return;
    }
    vec2 centre = vec2(pixel) + 0.5f;
    float turn = findTurn(pixel);
    NearField near = gatherNear(centre, reach, turn);
    float radius = confusionRadius(params, texelFetch(uMotionDepth, pixel, 0).z);
    vec3 color = findFar(centre, radius, turn, near, own.rgb);
    if (near.light.w > 0.0f) color = mix(color, near.light.rgb / near.light.w, near.covered);
    imageStore(uFiltered, pixel, vec4(storableColor(color), own.a));
}
