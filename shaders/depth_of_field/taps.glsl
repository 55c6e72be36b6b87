// SPDX-License-Identifier: MIT
// What filters of a lens read.
#include "common/sampling.glsl"
#include "depth_of_field/confusion.glsl"

layout(local_size_x = kLensGroup, local_size_y = kLensGroup) in;
layout(push_constant, scalar) uniform Push { LensFilterParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uReach; // reach.comp

struct Tap {
    vec3 color;
    float confusion; // radius, signed
};

/// Fetches the pixel that holds the place; the border goes on outside.
Tap takeTap(vec2 place) {
    ivec2 pixel = clamp(ivec2(floor(place)), ivec2(0), ivec2(params.sizePx) - 1);
    return Tap(
        texelFetch(uColor, pixel, 0).rgb,
        confusionRadius(params, texelFetch(uMotionDepth, pixel, 0).z)
    );
}

/// Rotation of the pixel's disc of taps, radians.
float findTurn(ivec2 pixel) { return 6.28318531f * unitFloat(hashPixel(uvec2(pixel), 0u, 0u)); }
