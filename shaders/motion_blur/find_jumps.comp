// SPDX-License-Identifier: MIT
// Marks blocks near which surfaces come apart (jump.glsl), in a picture of blocks cleared to 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/jump.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"
#define SHUTTER_BLOCK_LIST_BINDING 3
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform usampler2D uEntityId;
layout(binding = 2, r32ui) uniform uimage2D uJumps;

vec2 uvOf(ivec2 pixel) { return (vec2(pixel) + 0.5f) / vec2(params.sizePx); }

vec3 motionDepthAt(vec2 uv) {
    vec3 texel = textureLod(uMotionDepth, uv, 0.0f).xyz;
    return vec3(shownMotion(texel.xy, texel.z, params.maxMotionDepth), texel.z);
}

struct Jump {
    bool isFound;
    float depth; // of the nearer surface
    ivec2 pixel; // where that is
};

/// The jump from the pixel to its neighbour; beyond the picture the sampler has its last pixel, which
/// is none.
Jump findJump(ivec2 pixel, ivec2 neighbour, vec3 own) {
    vec3 other = motionDepthAt(uvOf(neighbour));
    Jump jump = Jump(false, min(own.z, other.z), own.z <= other.z ? pixel : neighbour);
    if (!moveApart(own.xy, other.xy)) return jump;
    float soft = softExtent(jump.depth, params.softDepthExtent, params.softDepthShare);
    jump.isFound = abs(own.z - other.z) > soft || textureLod(uEntityId, uvOf(pixel), 0.0f).x !=
                                                      textureLod(uEntityId, uvOf(neighbour), 0.0f).x;
    return jump;
}

void mark(Jump jump) {
    if (!jump.isFound) return;
    int reach = int(kJumpReachPx);
    int size = int(kGroupSize);
    ivec2 first = max(jump.pixel - reach, ivec2(0)) / size;
    ivec2 last = min(jump.pixel + reach, ivec2(params.sizePx) - 1) / size;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            ivec2 place = jump.pixel - ivec2(x, y) * size;
            imageAtomicMax(uJumps, ivec2(x, y), markJump(jump.depth, place));
        }
}

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec3 own = motionDepthAt(uvOf(pixel));
    mark(findJump(pixel, pixel + ivec2(1, 0), own));
    mark(findJump(pixel, pixel + ivec2(0, 1), own));
}
