// SPDX-License-Identifier: MIT
// The longest motion of each entity's pixels. Lengths that are not negative compare as their bits do.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "render/longest_motion_shared.h"

layout(local_size_x = kLongestMotionGroup, local_size_y = kLongestMotionGroup) in;
layout(push_constant, scalar) uniform Push { LongestMotionParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform usampler2D uEntityId;
layout(binding = 2, scalar) buffer Longest { uint uLongest[]; }; // bits of pixels, one a row, the sky's last

// Most groups see one entity: it is asked once a group.
shared uint sRow;
shared uint sLongest;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool isInside = all(lessThan(uvec2(pixel), params.sizePx));
    uint row = params.rowCount;
    float speed = 0.0f;
    if (isInside) {
        row = min(texelFetch(uEntityId, pixel, 0).x, params.rowCount);
        speed = length(texelFetch(uMotionDepth, pixel, 0).xy);
    }
    if (gl_LocalInvocationIndex == 0u) { // whose pixel is always inside
        sRow = row;
        sLongest = 0u;
    }
    barrier();
    if (speed > 0.0f) { // not NaN
        if (row == sRow)
            atomicMax(sLongest, floatBitsToUint(speed));
        else
            atomicMax(uLongest[row], floatBitsToUint(speed));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && sLongest > 0u) atomicMax(uLongest[sRow], sLongest);
}
