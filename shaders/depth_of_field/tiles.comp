// SPDX-License-Identifier: MIT
// Largest circle of confusion and nearest depth of each tile. A group per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "depth_of_field/confusion.glsl"

layout(local_size_x = kLensGroup, local_size_y = kLensGroup) in;
layout(push_constant, scalar) uniform Push { LensFilterParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1, rg32f) uniform writeonly image2D uTiles;

shared uint sLargest; // bits of a float that is 0 or more: they rise with it
shared uint sNearest;

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        sLargest = 0u;
        sNearest = floatBitsToUint(3.0e38f);
    }
    barrier();
    uvec2 first = gl_WorkGroupID.xy * params.tilePx;
    uvec2 end = min(first + params.tilePx, params.sizePx);
    float largest = 0.0f;
    float nearest = 3.0e38f;
    for (uint y = first.y + gl_LocalInvocationID.y; y < end.y; y += kLensGroup)
        for (uint x = first.x + gl_LocalInvocationID.x; x < end.x; x += kLensGroup) {
            float depth = texelFetch(uMotionDepth, ivec2(x, y), 0).z;
            largest = max(largest, abs(confusionRadius(params, depth)));
            if (isFinite(depth) && depth > 0.0f) nearest = min(nearest, depth);
        }
    atomicMax(sLargest, floatBitsToUint(largest));
    atomicMin(sNearest, floatBitsToUint(nearest));
    barrier();
    if (gl_LocalInvocationIndex == 0u)
        imageStore(
            uTiles, ivec2(gl_WorkGroupID.xy),
            vec4(uintBitsToFloat(sLargest), uintBitsToFloat(sNearest), 0.0f, 0.0f)
        );
}
