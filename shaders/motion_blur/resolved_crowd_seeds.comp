// SPDX-License-Identifier: MIT
// Seeds for tiles whose candidate lists overflow: one place for each distinct motion over the tile,
// at which the search of a pixel begins. Marks the tiles that unlisted entities reach. A group
// processes a tile of a layer, a thread a row of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved.glsl"

layout(local_size_x = kCandidateTilePx) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0) uniform usampler2D uSurface;
layout(binding = 1) uniform usampler2D uLastSurface;
layout(binding = 2) uniform usampler2D uSecondSurface;
layout(binding = 3) uniform sampler2D uMotionDepth; // of this frame's raster

#include "motion_blur/resolved_crowds.glsl"
#include "motion_blur/resolved_extents.glsl"

/// Ways that differ by less have one seed: the search finds one from the other.
const float kSeedCellPx = 2.0f;
/// Longest way whose cells are that small; those of longer ones are as many times larger.
const float kFineWayPx = 16.0f;

vec2 fetchMotion(ivec2 pixel) { return textureLod(uMotionDepth, uvOfPixel(pixel), 0.0f).xy; }

void growMotion(ivec2 pixel, inout Extent extent) {
    vec2 motion = fetchMotion(pixel);
    extent.motionLow = min(extent.motionLow, motion);
    extent.motionHigh = max(extent.motionHigh, motion);
}

uvec2 fetchSurface(uint layer, ivec2 pixel) {
    vec2 uv = uvOfPixel(pixel);
    if (layer == kLastLayer) return textureLod(uLastSurface, uv, 0.0f).xy;
    if (layer == kSecondLayer) return textureLod(uSecondSurface, uv, 0.0f).xy;
    return textureLod(uSurface, uv, 0.0f).xy;
}

/// Whether the layer's entities in the tile are in no list.
bool isUnlisted(uint layer, uint tile) {
    uint listed = CrowdTable(method.crowds).tiles[tile].listed;
    return (listed & (kSourceIsListed << layer)) == 0u;
}

/// Instants between which a way is taken as straight.
const uint kWayInstants = 5u;

uint wayInstant(uint index) { return index * (method.instantCount - 1u) / (kWayInstants - 1u); }

/// Where the extent's first pixel is seen at an instant.
vec2 placeAt(LayerMotion layer, Extent extent, uint instant, bool perspective) {
    vec2 at = vec2(extent.low) + 0.5f;
    if (extent.deforms) {
        float time = timeOf(InstantMotionsRef(method.motions), instant) - params.rasterTime;
        return at + fetchMotion(extent.low) * time;
    }
    uint mover = findMover(layer, extent.key);
    InstantMotion motion = motionAt(method, has(method, kHasLensPlaces), layer, mover, instant);
    vec3 seen =
        transformRows(motion.instantFromRaster, pictureSpace(at, extent.depths.x, perspective));
    return clamp(projectPicture(seen, perspective), -1.0e6f, 1.0e6f);
}

/// Neighbouring cells have distinct slots: the nearest two with the same slot are 4.5 apart.
uint findSlot(vec2 way) {
    float fine = max(length(way) / kFineWayPx, 1.0f);
    float cellPx = kSeedCellPx * exp2(floor(log2(fine)));
    ivec2 cell = ivec2(round(way / cellPx));
    // The remainder of a negative number is undefined. Coordinates are in [-16, 16], so the sum is
    // positive.
    return uint(cell.x + 7 * cell.y + 8 * int(kCrowdSeeds)) % kCrowdSeeds;
}

/// How the extent's first pixel goes in the course of the exposure.
struct Way {
    float lengthPx;
    vec2 farthest; // from where it is first
};

Way findWay(LayerMotion layer, Extent extent, bool perspective) {
    vec2 start = placeAt(layer, extent, 0u, perspective);
    vec2 before = start;
    Way way = Way(0.0f, vec2(0.0f));
    for (uint i = 1u; i < kWayInstants; ++i) {
        vec2 place = placeAt(layer, extent, wayInstant(i), perspective);
        way.lengthPx += distance(place, before);
        if (distance(place, start) > length(way.farthest)) way.farthest = place - start;
        before = place;
    }
    return way;
}

SeenBox unite(SeenBox a, SeenBox b) {
    return SeenBox(
        min(a.low, b.low), max(a.high, b.high),
        vec2(min(a.depths.x, b.depths.x), max(a.depths.y, b.depths.y)), a.parts | b.parts
    );
}

/// \param first of the layer's tiles in the table
void enterExtent(
    LayerMotion layer, uint first, Extent extent, bool unlisted, bool perspective
) {
    if (!extent.isOfUse) return;
    Way way = findWay(layer, extent, perspective);
    uint wayInverted = ~floatBitsToUint(way.lengthPx);
    uint slot = findSlot(way.farthest);
    uint seed = uint(extent.low.x) | uint(extent.low.y) << 16;
    uint across = countTiles(params.sizePx).x;
    CrowdTable crowds = CrowdTable(method.crowds);
    SeenBox before = kNoBox;
    for (uint i = 0u; i < kWayInstants; ++i) {
        SeenBox box = kNoBox;
        addInstant(layer, extent, wayInstant(i), perspective, box);
        SeenBox both = unite(before, box);
        before = box;
        if (both.parts == 0u) continue;
        TileRange range = findTiles(both);
        for (uint y = range.from.y; y <= range.to.y; ++y)
            for (uint x = range.from.x; x <= range.to.x; ++x) {
                uint tile = y * across + x;
                if (unlisted) noteUnlisted(tile, kTileIsListed);
                atomicMin(crowds.tiles[tile].wayInverted, wayInverted);
                atomicMin(crowds.tiles[first + tile].seeds[slot], seed);
            }
    }
}

void main() {
    uint index = gl_WorkGroupID.z;
    if (index == kLastLayer && !has(method, kHasLastLayer)) return;
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    LayerMotion layer = getLayer(motions, index);
    bool perspective = motions.value.isPerspective != 0u;
    uvec2 tiles = countTiles(params.sizePx);
    bool unlisted = isUnlisted(index, gl_WorkGroupID.y * tiles.x + gl_WorkGroupID.x);
    uvec2 begin = gl_WorkGroupID.xy * kCandidateTilePx + uvec2(0u, gl_LocalInvocationID.x);
    if (begin.y >= params.sizePx.y) return;
    uint first = index * tiles.x * tiles.y;
    Extent extent = kNoExtent;
    uint end = min(begin.x + kCandidateTilePx, params.sizePx.x);
    for (uint x = begin.x; x < end; ++x) {
        ivec2 pixel = ivec2(x, begin.y);
        uvec2 surface = fetchSurface(index, pixel);
        uint key = keyOf(surface);
        if (key != extent.key) {
            enterExtent(layer, first, extent, unlisted, perspective);
            extent = beginExtent(layer, key);
            // The motion of deforming entities is in motion vectors, which other rasters lack.
            if (extent.deforms && index != kRasterLayer) extent.isOfUse = false;
        }
        growExtent(surface, pixel, extent);
        if (extent.deforms && extent.isOfUse) growMotion(pixel, extent);
    }
    enterExtent(layer, first, extent, unlisted, perspective);
}
