// SPDX-License-Identifier: MIT
// Counts taps in blocks with masked pixels: inside the ray mask over the raster's layer and the revealed
// one, outside over the raster's alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 9
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3) uniform usampler2D uEntityId;
layout(binding = 4) uniform sampler2D uRevealColor;
layout(binding = 5) uniform sampler2D uRevealMotionDepth;
layout(binding = 6) uniform usampler2D uRevealEntityId;
layout(binding = 7) uniform sampler2D uMask;
layout(binding = 8, rgba16f) uniform writeonly image2D uBlurred;

#include "motion_blur/count_taps.glsl"

bool isMasked(vec2 uv) { return textureLod(uMask, uv, 0.0f).x > 0.5f; }

Surface revealedSurface(vec2 centre) {
    vec2 uv = uvOf(centre);
    return makeSurface(
        centre, textureLod(uRevealEntityId, uv, 0.0f).x, shownMotionDepth(uRevealMotionDepth, uv),
        textureLod(uRevealColor, uv, 0.0f).rgb
    );
}

/// What lies behind at instant u, blurred by its own motion: from the raster where that shows it, else
/// from the revealed layer.
vec3 findBehind(Surface behind, float u) {
    vec2 uv = uvOf(behind.centre + behind.motionDepth.xy * u);
    if (textureLod(uEntityId, uv, 0.0f).x == behind.id) return textureLod(uColor, uv, 0.0f).rgb;
    if (isMasked(uv) && textureLod(uRevealEntityId, uv, 0.0f).x == behind.id)
        return textureLod(uRevealColor, uv, 0.0f).rgb;
    return behind.color;
}

/// The surface itself at instant u, or another one before the background that comes there; else the
/// background, which neither hides then.
vec3 findOwnOrBehind(Surface surface, Surface behind, Arc arc, float u) {
    vec2 offset = placeOnArc(arc, u);
    vec2 uv = uvOf(surface.centre + offset);
    vec3 there = shownMotionDepth(uMotionDepth, uv);
    bool isHere = textureLod(uEntityId, uv, 0.0f).x == surface.id ||
                  (there.z < behind.nearerDepth &&
                   distanceAt(surface.centre, offset, there.xy, u) < kReachPx);
    return isHere ? textureLod(uColor, uv, 0.0f).rgb : findBehind(behind, u);
}

vec3 countBoth(vec2 dominant, vec2 centre) {
    Surface surface = surfaceInRaster(centre);
    Surface behind = revealedSurface(centre);
    Arc arc = findArc(surface);
    float firstTap = placeFirstTap(centre);
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < countTaps(); ++i) {
        float u = placeTap(i, firstTap);
        vec3 color = vec3(0.0f);
        if (!findPassing(surface, dominant, u, color))
            color = findOwnOrBehind(surface, behind, arc, u);
        sum += color;
    }
    return sum / float(countTaps());
}

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 dominant = dominantAt(centre);
    // Nothing moves within reach: the sharp colour, bit for bit.
    if (length(dominant) < kStillPx) {
        imageStore(uBlurred, pixel, textureLod(uColor, uvOf(centre), 0.0f));
        return;
    }
    vec3 seen = isMasked(uvOf(centre)) ? countBoth(dominant, centre)
                                       : countRaster(dominant, centre, false);
    imageStore(uBlurred, pixel, vec4(seen, 1.0f));
}
