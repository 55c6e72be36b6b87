// SPDX-License-Identifier: MIT
// Counts taps over the raster's layer in blocks where surfaces hide each other, and notes the taps that
// saw what the raster does not have: the background that a surface uncovers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/hybrid_shared.h"
#include "motion_blur/jump.glsl"
#include "motion_blur/missing_taps.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/ray_share.glsl"
#define SHUTTER_BLOCK_LIST_BINDING 8
#define SHUTTER_BLOCK_LIST_ACCESS // the flags are written
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    HybridParams method;
};
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3) uniform usampler2D uEntityId;
layout(binding = 4) uniform usampler2D uJumps;
layout(binding = 5, rgba16f) uniform writeonly image2D uBlurred; // where no tap is missing
layout(binding = 6, rgba16f) uniform writeonly image2D uSeen;    // elsewhere; a: share of missing taps
layout(binding = 7, r32ui) uniform writeonly uimage2D uMissing;  // which (missing_taps.glsl)
layout(binding = 9, scalar) buffer SortedBlocks {
    BlockHeader header;
    uint entries[];
} uSorted;
layout(binding = 10, scalar) buffer SortedArguments { DispatchArguments uLists[kListCount]; };

#include "motion_blur/count_alone.glsl"
#include "motion_blur/masked_blocks.glsl"

/// How far from the pixel's centre a surface that hides others may come to lie: half a pixel is exact,
/// and a tenth closes the gaps where neighbours move apart.
const float kReachPx = 0.6f;

/// A path that leaves its chord by less is searched as a straight one.
const float kMaxBendPx = 16.0f;

/// Motions of what may pass, over the exposure.
struct Passing {
    vec2 dominant;
    vec2 nearest; // of the nearest surface at a jump
    bool triesDominant;
    bool triesNearest;
};

vec2 dominantAt(vec2 centre) {
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    return textureLod(uDominant, tile, 0.0f).xy;
}

/// How far the surface that the raster has at `offset` from the pixel is from it at instant u: pixels,
/// along the axis that is farther.
float distanceAt(vec2 centre, vec2 offset, vec2 motion, float u) {
    vec2 place = floor(centre + offset) + 0.5f - centre;
    vec2 left = abs(place - motion * u);
    return max(left.x, left.y);
}

/// Whether something before the surface is at the pixel at instant u, where its raster place is guessed
/// to be at `offset`; what is there gives the next guess.
bool findPassing(Surface surface, vec2 offset, float u, out vec2 uv) {
    uv = uvOf(surface.centre + offset);
    vec3 passing = shownMotionDepth(uMotionDepth, uv);
    if (!(passing.z < surface.nearerDepth)) return false;
    if (distanceAt(surface.centre, offset, passing.xy, u) < kReachPx) return true;
    offset = passing.xy * u;
    uv = uvOf(surface.centre + offset);
    passing = shownMotionDepth(uMotionDepth, uv);
    return passing.z < surface.nearerDepth &&
           distanceAt(surface.centre, offset, passing.xy, u) < kReachPx;
}

/// Sets `color` where something before the surface is at the pixel at instant u. The search begins where
/// that would be with the dominant motion, with that of the nearest jump, and with half of the dominant.
bool findPassing(Surface surface, Passing passing, float u, inout vec3 color) {
    vec2 uv;
    bool isFound =
        (passing.triesDominant && findPassing(surface, passing.dominant * u, u, uv)) ||
        (passing.triesNearest && findPassing(surface, passing.nearest * u, u, uv)) ||
        (passing.triesDominant && findPassing(surface, passing.dominant * (0.5f * u), u, uv));
    if (!isFound) return false;
    color = textureLod(uColor, uv, 0.0f).rgb;
    return true;
}

struct Jump {
    uint mark;
    vec2 block;
};

Jump nearerOf(Jump a, Jump b) {
    if (a.mark >= b.mark) return a;
    return b;
}

/// The nearest jump close to the line on which surfaces of that motion come to the pixel.
Jump findJumpAlong(vec2 centre, vec2 motion) {
    vec2 toBlocks = vec2(1.0f / float(kGroupSize));
    vec2 blockCount = ceil(vec2(params.sizePx) * toBlocks);
    vec2 last = vec2(params.sizePx) - 0.5f;
    vec2 first = centre + motion * (params.rasterTime - 1.0f);
    float steps = countJumpSteps(motion);
    Jump nearest = Jump(kNoJump, vec2(0.0f));
    for (float i = 0.0f; i <= steps; i += 1.0f) {
        vec2 block = clamp(first + motion * (i / steps), vec2(0.5f), last) * toBlocks;
        uint mark = textureLod(uJumps, block / blockCount, 0.0f).x;
        nearest = nearerOf(nearest, Jump(mark, block));
    }
    return nearest;
}

bool isAlike(vec2 a, vec2 b) {
    vec2 apart = a - b;
    return dot(apart, apart) < kStillPx * kStillPx;
}

bool mayPass(Surface surface, vec2 motion, Jump jump) {
    // What has its own motion is found where the surface itself is looked for.
    return jump.mark != kNoJump && depthOfJump(jump.mark) < surface.nearerDepth &&
           !isAlike(motion, surface.motionDepth.xy);
}

Surface surfaceAtJump(Jump jump) {
    vec2 pixel = floor(jump.block) * float(kGroupSize) + vec2(placeOfJump(jump.mark));
    return surfaceInRaster(pixel + 0.5f);
}

/// How far a surface's path leaves the straight one within the exposure, pixels.
float findBend(Surface surface) {
    Arc arc = findArc(surface);
    vec2 motion = surface.motionDepth.xy;
    float before = params.rasterTime - 1.0f;
    float after = params.rasterTime;
    return max(
        length(placeOnArc(arc, before) - motion * before),
        length(placeOnArc(arc, after) - motion * after)
    );
}

/// Whether another surface may be seen at the pixel, and which motions it may have.
bool meetsOthers(Surface surface, vec2 dominant, out Passing passing) {
    vec2 motion = surface.motionDepth.xy;
    vec2 apart = dominant - motion;
    Jump jump = findJumpAlong(surface.centre, dominant);
    bool triesDominant = mayPass(surface, dominant, jump);
    if (dot(apart, apart) > kAlikePx * kAlikePx)
        jump = nearerOf(jump, findJumpAlong(surface.centre, motion));
    passing = Passing(dominant, vec2(0.0f), triesDominant, false);
    if (jump.mark == kNoJump) return false;
    Surface nearest = surfaceAtJump(jump);
    passing.nearest = nearest.motionDepth.xy;
    // For a surface that turns far, the straight guess finds pixels that have left by then.
    passing.triesNearest = mayPass(surface, passing.nearest, jump) &&
                           !isAlike(passing.nearest, dominant) && findBend(nearest) < kMaxBendPx;
    return true;
}

/// Sets `color` to what the raster shows of the surface at instant u, or of another one that comes to
/// the pixel then. Where something hides the surface, the pixel's own colour is the best guess.
/// \return whether it shows it; else the surface has gone by then, and what lies behind is seen
bool findOwn(Surface surface, Arc arc, float u, out vec3 color) {
    vec2 offset = placeOnArc(arc, u);
    vec2 uv = uvOf(surface.centre + offset);
    color = textureLod(uColor, uv, 0.0f).rgb;
    if (textureLod(uEntityId, uv, 0.0f).x == surface.id) return true;
    vec3 there = shownMotionDepth(uMotionDepth, uv);
    if (distanceAt(surface.centre, offset, there.xy, u) < kReachPx) return true;
    if (there.z >= surface.nearerDepth) return false;
    color = surface.color;
    return true;
}

struct Counted {
    vec3 sum;
    uint missingCount;
    uint missing; // bits
};

Counted countRaster(Surface surface, Passing passing, bool mayMiss) {
    vec2 motion = surface.motionDepth.xy;
    bool isStill = dot(motion, motion) < kStillPx * kStillPx;
    bool isPassed = passing.triesDominant || passing.triesNearest;
    Arc arc = findArc(surface);
    float firstTap = placeFirstTap(surface.centre);
    Counted counted = Counted(vec3(0.0f), 0u, 0u);
    for (uint i = 0u; i < countTaps(); ++i) {
        float u = placeTap(i, firstTap);
        vec3 color = surface.color;
        bool isShown = isPassed && findPassing(surface, passing, u, color);
        if (!isShown && !isStill) isShown = findOwn(surface, arc, u, color);
        if (!isShown && !isStill && mayMiss) {
            ++counted.missingCount;
            counted.missing |= 1u << bitOfTap(i, countTaps());
        } else {
            counted.sum += color;
        }
    }
    return counted;
}

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 dominant = dominantAt(centre);
    Surface surface = surfaceInRaster(centre);
    vec4 color = textureLod(uColor, uvOf(centre), 0.0f);
    Counted counted = Counted(vec3(0.0f), 0u, 0u);
    // Where nothing moves within reach, the sharp colour stays, bit for bit.
    if (length(dominant) >= kStillPx) {
        float perTap = 1.0f / float(countTaps());
        Passing passing;
        if (meetsOthers(surface, dominant, passing)) {
            uint tracing = chooseTracing(vec2(uvec2(pixel) / kGroupSize), method.rayShare);
            counted = countRaster(surface, passing, tracing != kTraceNothing);
            color = vec4(counted.sum * perTap, 1.0f);
        } else {
            color = vec4(countAlone(surface), 1.0f);
        }
        if (counted.missing != 0u) color.a = float(counted.missingCount) * perTap;
    }
    imageStore(uMissing, pixel, uvec4(counted.missing, 0u, 0u, 0u));
    if (counted.missing == 0u) {
        imageStore(uBlurred, pixel, color);
    } else {
        imageStore(uSeen, pixel, color);
        listBlock(uvec2(pixel) / kGroupSize);
    }
}
