// SPDX-License-Identifier: MIT
// The raster's depth and entity id in one image, so that a probe is one fetch, which also flags
// whether other entities are near. The including shader defines keepColor().
#ifndef SHUTTER_RESOLVED_SURFACE_GLSL
#define SHUTTER_RESOLVED_SURFACE_GLSL

#include "motion_blur/resolved.glsl"

/// Difference of depth between neighbours, as a share, from which they may be two surfaces.
const float kEdgeShare = 0.03f;

/// Whether pixels with motion vectors of 0 get no corners. Usually no sample is looked up in them;
/// if one is, it takes the slower path for edges.
layout(constant_id = 0) const bool kSkipsStill = false;
layout(constant_id = 1) const bool kHasEdges = false; // pixels may show two surfaces

/// For the next frame, where the pass does so.
void keepColor(ivec2 pixel);

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform usampler2D uEntityId;
layout(binding = 2, rg32ui) uniform writeonly uimage2D uSurface;

// texelFetch is slow on software devices
vec2 uvOf(ivec2 at) { return (vec2(at) + 0.5f) / vec2(params.sizePx); }

uint fetchKey(ivec2 at) { return keyOfId(textureLod(uEntityId, uvOf(at), 0.0f).x); }

uint fetchOtherSamples(ivec2 at) {
    return kHasEdges ? uint(textureLod(uMotionDepth, uvOf(at), 0.0f).w) : 0u;
}

float fetchDepth(ivec2 at) { return max(textureLod(uMotionDepth, uvOf(at), 0.0f).z, 0.0f); }

/// Whether two neighbours of one entity are one surface as far as depths tell.
bool isNear(float a, float b) { return abs(a - b) <= kEdgeShare * max(a, b); }

/// A bit for each corner of the pixel: the four pixels that meet there are of one entity, and of one
/// surface as far as depths tell. The picture goes on as it ends.
uint findInnerCorners(ivec2 pixel, uint key, float depth) {
    uint corners = 0u;
    if (kHasEdges) {
        bool isSame[9];
        for (uint i = 0u; i < 9u; ++i) {
            ivec2 at = pixel + ivec2(i % 3u, i / 3u) - 1;
            isSame[i] = i == 4u || (fetchKey(at) == key && fetchOtherSamples(at) == 0u &&
                                   isNear(fetchDepth(at), depth));
        }
        return (isSame[0] && isSame[1] && isSame[3] ? 1u : 0u) |
               (isSame[1] && isSame[2] && isSame[5] ? 2u : 0u) |
               (isSame[3] && isSame[6] && isSame[7] ? 4u : 0u) |
               (isSame[5] && isSame[7] && isSame[8] ? 8u : 0u);
    }
    for (uint corner = 0u; corner < 4u; ++corner) {
        vec2 at = vec2(pixel + ivec2(corner & 1u, corner >> 1u)) / vec2(params.sizePx);
        uvec4 ids = textureGather(uEntityId, at, 0);
        vec4 depths = max(textureGather(uMotionDepth, at, 2), vec4(0.0f));
        vec2 ends = vec2(
            min(min(depths.x, depths.y), min(depths.z, depths.w)),
            max(max(depths.x, depths.y), max(depths.z, depths.w))
        );
        bool isSame = ids.x == ids.y && ids.x == ids.z && ids.x == ids.w;
        if (isSame && isNear(ends.x, ends.y)) corners |= 1u << corner;
    }
    return corners;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    keepColor(pixel);
    uint key = fetchKey(pixel);
    vec4 motionDepth = textureLod(uMotionDepth, uvOf(pixel), 0.0f);
    uint others = kHasEdges ? uint(motionDepth.w) : 0u;
    uint corners = 0u;
    if (others == 0u && (kHasEdges || !kSkipsStill || motionDepth.xy != vec2(0.0f)))
        corners = findInnerCorners(pixel, key, max(motionDepth.z, 0.0f));
    imageStore(
        uSurface, pixel,
        uvec4(
            floatBitsToUint(max(motionDepth.z, 0.0f)),
            key | corners << kCornerShift | others << kSampleShift, 0u, 0u
        )
    );
}

#endif
