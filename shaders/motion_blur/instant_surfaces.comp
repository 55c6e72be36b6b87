// SPDX-License-Identifier: MIT
// Writes the surfaces visible in each pixel of a rectangle at some of the instants
// (common/instant_surfaces.glsl), for surfaces drawn over the blurred picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved_shared.h"
#include "motion_blur/motion_blur_shared.h"

const bool kFindsEdges = false;

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};

#include "motion_blur/resolved_search.glsl"

layout(binding = 23, scalar) buffer Surfaces {
    InstantSurfaces uHead;
    uint uWords[];
};

/// Whether any surface may move over the pixel; only such pixels were searched.
bool mayChange(PixelSearch pixel) {
    if (kHasCrowds && pixel.isCrowded) return true;
    if (getCandidate(kRasterLayer, pixel.tile, 0u).key != kNoKey) return true;
    if (kHasSecond && getCandidate(kSecondLayer, pixel.tile, 0u).key != kNoKey) return true;
    return has(method, kHasLastLayer) && getCandidate(kLastLayer, pixel.tile, 0u).key != kNoKey;
}

/// Depth at an instant of a block's plane in this frame's raster.
float depthOfPlane(PixelSearch pixel, Seen seen, uint instant) {
    ivec2 texel = keepInside(ivec2(seen.at));
    Probe surface = fetchSurface(kRasterLayer, texel);
    uint mover = findMover(pixel.raster, surface.key);
    if (surface.key == kSkyKey) return kFarthest;
    bool isRigid = mover != kNoMover && mover != kDeformedMover;
    if (!isRigid || isStillMover(pixel.raster, mover)) return surface.depth;
    InstantMotion motion = motionAt(method, kHasLens, pixel.raster, mover, instant);
    return dot(
        motion.instantFromRaster[2],
        pictureSpace(vec2(texel) + 0.5f, surface.depth, pixel.perspective)
    );
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, uHead.sizePx))) return;
    ivec2 pixel = ivec2(uHead.originPx + at);
    PixelSearch search = beginSearch(pixel);
    Probe shown = fetchSurface(kRasterLayer, pixel);
    float shownDepth = behindSky(shown.key, shown.depth);
    bool changes = mayChange(search);
    Guesses guesses = beginGuesses(search);
    vec4 sum = vec4(0.0f);
    uint part = 0u;
    float before = 0.0f;
    for (uint i = 0u; i < uHead.instantCount; ++i) {
        float depth = shownDepth;
        if (changes) {
            // A surface that no raster shows was hidden in all of them, so it lies behind those
            // that they show.
            depth = kFarthest;
            uint taken = takenInstant(i, uHead.instantCount, params.sampleCount);
            uint instant = taken * method.setCount + search.set;
            Doubt doubt = kNoDoubt;
            Seen seen = searchPlace(search, instant, guesses, doubt);
            if (seen.isFound) {
                bool isPlane = seen.key == kNoKey;
                depth = isPlane ? depthOfPlane(search, seen, instant) : seen.depth;
                sum += vec4(colorOf(seen), 1.0f);
            }
        }
        bool isLast = i + 1u == uHead.instantCount;
        if ((i & 1u) == 1u || isLast)
            uWords[surfaceDepthWord(uHead, i, at)] =
                (i & 1u) == 1u ? packHalf2x16(vec2(before, depth)) : packHalf2x16(vec2(depth));
        before = depth;
        if (!isLast && surfacePartOf(uHead, i + 1u) == part) continue;
        vec3 mean = sum.rgb / max(sum.a, 1.0f);
        uint word = surfacePartWord(uHead, part, at);
        uWords[word] = packHalf2x16(mean.rg);
        uWords[word + 1u] = packHalf2x16(vec2(mean.b, sum.a));
        sum = vec4(0.0f);
        ++part;
    }
}
