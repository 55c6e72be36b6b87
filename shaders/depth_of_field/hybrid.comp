// SPDX-License-Identifier: MIT
// The near field over what rays saw behind it, in their mask, and over the far field of the raster
// elsewhere (lens_rays.comp).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "depth_of_field/near_far.glsl"

layout(binding = 3) uniform sampler2D uNear;
layout(binding = 4) uniform sampler2D uBehind;
layout(binding = 5, rgba16f) uniform writeonly image2D uFiltered;

const int kFilterPx = 2; // pixels on each side that rays' noise is averaged over

/// The mean of what rays saw in pixels that both circles of confusion reach well: less noise, and
/// nothing in focus is blurred.
vec3 filterBehind(ivec2 pixel, vec4 own) {
    vec4 sum = vec4(0.0f);
    for (int y = -kFilterPx; y <= kFilterPx; ++y)
        for (int x = -kFilterPx; x <= kFilterPx; ++x) {
            ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), ivec2(params.sizePx) - 1);
            vec4 other = texelFetch(uBehind, at, 0);
            if (other.a < 0.0f) continue;
            float radius = 0.5f * min(own.a, other.a);
            sum += coverRim(radius, length(vec2(x, y))) * vec4(other.rgb, 1.0f);
        }
    return sum.rgb / sum.w;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.sizePx)))) return;
    vec4 own = texelFetch(uColor, pixel, 0);
    // Nothing within reach is out of focus: the sharp colour, bit for bit.
    if (texelFetch(uReach, pixel / int(params.tilePx), 0).x < kSharpPx) {
        imageStore(uFiltered, pixel, own);
        return;
    }
    vec4 near = texelFetch(uNear, pixel, 0);
    vec4 behind = texelFetch(uBehind, pixel, 0);
    float radius = confusionRadius(params, texelFetch(uMotionDepth, pixel, 0).z);
    vec3 color = behind.rgb;
    if (behind.a >= 0.0f)
        color = filterBehind(pixel, behind);
    else if (radius >= -kSharpPx)
        color = findFar(vec2(pixel) + 0.5f, radius, findTurn(pixel), own.rgb);
    imageStore(uFiltered, pixel, vec4(storableColor(mix(color, near.rgb, near.a)), own.a));
}
