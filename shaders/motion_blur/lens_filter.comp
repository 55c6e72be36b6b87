// SPDX-License-Identifier: MIT
// Averages out what differs between neighbouring pixels only because each sees through places of the lens
// of its own. A pixel that has a radius has its negative as alpha (resolved_lens.glsl); the
// others come through as they are.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/resolved_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uPicture;
layout(binding = 1, rgba16f) uniform writeonly image2D uFiltered;

// texelFetch is slow on software devices
vec4 fetchPicture(ivec2 at) {
    return textureLod(uPicture, (vec2(at) + 0.5f) / vec2(params.sizePx), 0.0f);
}

/// What the pixel is blurred with: all within the radius of both.
vec3 filterAround(ivec2 pixel, vec4 own) {
    vec3 sum = own.rgb;
    float weights = 1.0f;
    const int kReach = int(ceil(kMaxLensFilterPx));
    for (int y = -kReach; y <= kReach; ++y)
        for (int x = -kReach; x <= kReach; ++x) {
            ivec2 at = pixel + ivec2(x, y);
            bool isInside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(params.sizePx)));
            bool isInReach = float(x * x + y * y) < (kMaxLensFilterPx + 0.5f) * (kMaxLensFilterPx + 0.5f);
            if (!isInside || !isInReach || (x == 0 && y == 0)) continue;
            vec4 other = fetchPicture(at);
            float radius = min(-own.a, -other.a);
            float weight = clamp(radius + 0.5f - length(vec2(x, y)), 0.0f, 1.0f);
            sum += weight * other.rgb;
            weights += weight;
        }
    return sum / weights;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec4 own = fetchPicture(pixel);
    if (own.a < 0.0f) own = vec4(filterAround(pixel, own), 1.0f);
    imageStore(uFiltered, pixel, own);
}
