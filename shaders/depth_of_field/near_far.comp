// SPDX-License-Identifier: MIT
// A near field over a far field, from the raster alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "depth_of_field/near_far.glsl"

layout(binding = 3, rgba16f) uniform writeonly image2D uFiltered;

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
    NearField near = gatherNear(centre, reach, turn, -kSharpPx);
    float radius = confusionRadius(params, texelFetch(uMotionDepth, pixel, 0).z);
    vec3 color =
        radius < -kSharpPx ? guessBehind(near) : findFar(centre, radius, turn, own.rgb);
    if (near.light.w > 0.0f) color = mix(color, near.light.rgb / near.light.w, near.covered);
    imageStore(uFiltered, pixel, vec4(storableColor(color), own.a));
}
