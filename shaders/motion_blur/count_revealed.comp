// SPDX-License-Identifier: MIT
// Adds the missing taps of masked pixels: what lies behind them, as rays have found it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/missing_taps.glsl"
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 9
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform usampler2D uEntityId;
layout(binding = 2) uniform sampler2D uRevealColor;
layout(binding = 3) uniform sampler2D uRevealMotionDepth;
layout(binding = 4) uniform usampler2D uRevealEntityId;
layout(binding = 5) uniform sampler2D uMask;
layout(binding = 6) uniform sampler2D uSeen;
layout(binding = 7) uniform usampler2D uMissing;
layout(binding = 8, rgba16f) uniform writeonly image2D uBlurred;

#include "motion_blur/count_taps.glsl"

bool isMasked(vec2 uv) { return textureLod(uMask, uv, 0.0f).x > 0.5f; }

/// What lies behind at instant u, blurred by its own motion: from the raster where that shows it, else
/// from the revealed layer.
vec3 findBehind(Surface behind, float u) {
    vec2 uv = uvOf(behind.centre + behind.motionDepth.xy * u);
    if (textureLod(uEntityId, uv, 0.0f).x == behind.id) return textureLod(uColor, uv, 0.0f).rgb;
    if (isMasked(uv) && textureLod(uRevealEntityId, uv, 0.0f).x == behind.id)
        return textureLod(uRevealColor, uv, 0.0f).rgb;
    return behind.color;
}

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 uv = uvOf(centre);
    uint missing = textureLod(uMissing, uv, 0.0f).x;
    if (missing == 0u) return;
    Surface behind = makeSurface(
        centre, textureLod(uRevealEntityId, uv, 0.0f).x, shownMotionDepth(uRevealMotionDepth, uv),
        textureLod(uRevealColor, uv, 0.0f).rgb
    );
    float firstTap = placeFirstTap(centre);
    vec3 sum = vec3(0.0f);
    for (uint left = missing; left != 0u; left &= left - 1u) {
        uint tap = tapOfBit(uint(findLSB(left)), countTaps());
        sum += findBehind(behind, placeTap(tap, firstTap));
    }
    vec4 seen = textureLod(uSeen, uv, 0.0f);
    vec3 color = seen.rgb + sum * (seen.a / float(bitCount(missing)));
    imageStore(uBlurred, pixel, vec4(color, 1.0f));
}
