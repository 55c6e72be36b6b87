// SPDX-License-Identifier: MIT
// What every kind of reveal reads and writes: the raster's pictures, the list of masked pixels, and the
// revealed layer, which holds masked pixels only.
#ifndef SHUTTER_MOTION_BLUR_REVEALED_PIXELS_GLSL
#define SHUTTER_MOTION_BLUR_REVEALED_PIXELS_GLSL

#include "motion_blur/hybrid_shared.h"
#include "motion_blur/motion_blur_shared.h"
#include "render/sky.glsl"

layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    HybridParams method;
};
layout(set = 0, binding = 0) uniform sampler2D uColor;
layout(set = 0, binding = 1) uniform sampler2D uMotionDepth;
layout(set = 0, binding = 2) uniform usampler2D uEntityId;
layout(set = 0, binding = 3) uniform sampler2D uMask;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D uRevealColor;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D uRevealMotionDepth;
layout(set = 0, binding = 6, r32ui) uniform writeonly uimage2D uRevealEntityId;
layout(set = 0, binding = 7, scalar) buffer MaskList {
    MaskHeader header;
    uint pixels[];
};

struct Revealed {
    vec3 color;
    vec4 motionDepth;
    uint entityId;
};

/// Where nothing hides anything: what raster shows.
Revealed keepRaster(vec2 uv) {
    return Revealed(
        textureLod(uColor, uv, 0.0f).rgb, textureLod(uMotionDepth, uv, 0.0f),
        textureLod(uEntityId, uv, 0.0f).x
    );
}

/// \param color of the sky in that direction
Revealed revealSky(FrameRef frame, vec3 color, vec2 centre, vec3 direction) {
    return Revealed(
        color,
        vec4(skyMotion(frame, centre, direction), kSkyDepth, 0.0f), kNoEntity
    );
}

/// \param entry of the list of masked pixels
ivec2 pixelOf(uint entry) {
    entry &= ~kQuadFlag;
    return ivec2(entry & 0xFFFFu, entry >> 16);
}

void storeAt(ivec2 pixel, Revealed revealed) {
    imageStore(uRevealColor, pixel, vec4(revealed.color, 1.0f));
    imageStore(uRevealMotionDepth, pixel, revealed.motionDepth);
    imageStore(uRevealEntityId, pixel, uvec4(revealed.entityId, 0u, 0u, 0u));
}

/// For the entry's pixel, and for those that share its ray.
void storeRevealed(uint entry, Revealed revealed) {
    ivec2 pixel = pixelOf(entry);
    storeAt(pixel, revealed);
    if ((entry & kQuadFlag) == 0u) return;
    for (int i = 1; i < 4; ++i) { // those before its own are not masked
        ivec2 sharing = (pixel & ~1) + ivec2(i & 1, i >> 1);
        if (sharing == pixel) continue;
        if (any(greaterThanEqual(uvec2(sharing), params.sizePx))) continue;
        vec2 uv = (vec2(sharing) + 0.5f) / vec2(params.sizePx);
        if (textureLod(uMask, uv, 0.0f).x > 0.5f) storeAt(sharing, revealed);
    }
}

#endif
