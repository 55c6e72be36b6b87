// SPDX-License-Identifier: MIT
// A near field over a far field (Sousa 2013, "CryENGINE 3 Graphics Gems"; Abadie 2018, "A Life of a
// Bokeh"). The near field gathers over the largest circle of confusion within reach and has the
// coverage of the circles of its taps; the far field gathers over the pixel's own circle, without
// leaks from surfaces in focus.
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

/// \param limit of the near field: surfaces with a smaller confusion (negative) are in it
NearField gatherNear(vec2 centre, float reach, float turn, float limit) {
    NearField near = NearField(vec4(0.0f), vec4(0.0f), 0.0f);
    // The centre tap represents the pixel's area, which widely spaced taps miss, along with circles
    // little larger than it.
    Tap own = takeTap(centre);
    float tapArea = kUnitDiscArea * reach * reach / float(params.tapCount);
    float missed = saturate(1.0f - 1.0f / tapArea);
    if (own.confusion < limit) near.light = missed / tapArea * spreadNear(own, 0.0f);
    for (uint i = 0u; i < params.tapCount; ++i) {
        vec2 offset = reach * discTap(i, params.tapCount, turn);
        Tap tap = takeTap(centre + offset);
        if (tap.confusion >= limit) {
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

/// What may lie behind a pixel that shows the near field: the mean of the taps that are not near.
vec3 guessBehind(NearField near) {
    return near.behind.w > 0.0f ? near.behind.rgb / near.behind.w : near.light.rgb / near.light.w;
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

/// The far field at a pixel that does not show the near one. \param radius the pixel's own, signed
vec3 findFar(vec2 centre, float radius, float turn, vec3 own) {
    if (radius <= kSharpPx) return own; // all taps lie in the pixel
    vec4 light = gatherFar(centre, radius, turn);
    return light.w > 1.0e-6f ? light.rgb / light.w : own;
}
