// SPDX-License-Identifier: MIT
// Fits a plane to each block of this frame's raster that may move. A thread per block.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/block_plane.glsl"
#include "motion_blur/pixel_ray.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0) uniform usampler2D uSurface;
layout(binding = 1, scalar) readonly buffer Candidates { TileCandidates uTiles[]; };
layout(binding = 2, scalar) writeonly buffer Planes { BlockPlane uPlanes[]; };

#include "motion_blur/resolved_crowds.glsl"

const BlockPlane kNoPlane = BlockPlane(0u, kNoMover, 0.0f, vec2(0.0f), 0.0f);

uvec2 fetchSurface(ivec2 pixel) {
    // texelFetch is slow on software devices
    return textureLod(uSurface, (vec2(pixel) + 0.5f) / vec2(params.sizePx), 0.0f).xy;
}

float alongOfPixel(uvec2 surface, bool perspective) {
    if (perspective && keyOf(surface) == kSkyKey) return 0.0f;
    return alongOf(uintBitsToFloat(surface.x), perspective);
}

/// \return a plane with the block's keys, and the mover of all its pixels if that can have one; for one
/// entity that deforms, its key in place of a plane
BlockPlane findKeys(ivec2 first, ivec2 size, LayerMotion layer, bool perspective) {
    BlockPlane plane = kNoPlane;
    uint lastKey = kNoKey;
    bool hasOne = true;
    uint runs = 0u; // of pixels of one entity
    for (int y = 0; y < size.y; ++y) {
        // Fetches a whole row before testing it, so that the fetches overlap.
        uint keys[kGroupSize];
        for (int x = 0; x < int(kGroupSize); ++x) {
            uvec2 surface = fetchSurface(first + ivec2(min(x, size.x - 1), y));
            keys[x] = keyOf(surface);
            if (otherSamplesOf(surface) == 0u) continue;
            hasOne = false;
            plane.keys = ~0u; // the entities of the other pixels are not stored
        }
        for (int x = 0; x < int(kGroupSize); ++x) {
            uint key = keys[x];
            if (key == lastKey) continue;
            plane.keys |= keyBit(key);
            uint mover = findMover(layer, key);
            if (mover == kSkyMover && perspective) mover = kWorldMover;
            hasOne = hasOne && (lastKey == kNoKey || mover == plane.mover);
            plane.mover = mover;
            lastKey = key;
            ++runs;
        }
    }
    if (!hasOne || plane.mover == kSkyMover || isStillMover(layer, plane.mover) ||
        any(lessThan(size, ivec2(kGroupSize))))
        plane.mover = kNoMover;
    if (plane.mover != kDeformedMover) return plane;
    plane.along = float(lastKey);
    if (runs > 1u) plane.mover = kNoMover;
    return plane;
}

/// By least squares.
void fitPlane(ivec2 first, bool perspective, inout BlockPlane plane) {
    float squares = 0.0f; // of the distances from the centre along one axis
    for (int y = 0; y < int(kGroupSize); ++y)
        for (int x = 0; x < int(kGroupSize); ++x) {
            vec2 from = vec2(x, y) + 0.5f - kHalfBlockPx;
            float along = alongOfPixel(fetchSurface(first + ivec2(x, y)), perspective);
            plane.along += along;
            plane.slope += from * along;
            squares += from.x * from.x;
        }
    plane.along /= float(kGroupSize * kGroupSize);
    plane.slope /= squares;
    for (int y = 0; y < int(kGroupSize); ++y)
        for (int x = 0; x < int(kGroupSize); ++x) {
            vec2 from = vec2(x, y) + 0.5f - kHalfBlockPx;
            float along = alongOfPixel(fetchSurface(first + ivec2(x, y)), perspective);
            plane.deviation =
                max(plane.deviation, abs(along - plane.along - dot(plane.slope, from)));
        }
}

void main() {
    uvec2 block = gl_GlobalInvocationID.xy;
    uvec2 blocks = (params.sizePx + kGroupSize - 1u) / kGroupSize;
    if (any(greaterThanEqual(block, blocks))) return;
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    LayerMotion layer = getLayer(motions, kRasterLayer);
    bool perspective = motions.value.isPerspective != 0u;
    uvec2 tiles = countTiles(params.sizePx);
    uvec2 tile = block * kGroupSize / kCandidateTilePx;
    ivec2 first = ivec2(block * kGroupSize);
    ivec2 size = min(ivec2(params.sizePx) - first, ivec2(kGroupSize));
    BlockPlane plane = kNoPlane;
    uint index = tile.y * tiles.x + tile.x;
    // A raster's entities are candidates of their tile, unless they are static or too many.
    if (uTiles[index].candidates[0].key != kNoKey || isCrowded(index))
        plane = findKeys(first, size, layer, perspective);
    if (plane.mover != kNoMover && plane.mover != kDeformedMover)
        fitPlane(first, perspective, plane);
    uPlanes[block.y * blocks.x + block.x] = plane;
}
