// SPDX-License-Identifier: MIT
// Sorts each tile's candidates, nearest first, and makes several of an entity that shows several surfaces,
// one behind the other. A thread per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "motion_blur/resolved.glsl"
#include "motion_blur/resolved_parts_shared.h"

const uint kThreads = kGroupSize * kSortRows;

layout(local_size_x = kGroupSize, local_size_y = kSortRows) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0, scalar) buffer RasterCandidates { TileCandidates uRaster[]; };
layout(binding = 1, scalar) buffer LastCandidates { TileCandidates uLast[]; };
layout(binding = 2, scalar) buffer SecondCandidates { TileCandidates uSecond[]; };

/// A tile's candidates while they are sorted, by slot and thread: device memory is slow to reach.
shared uint sKeys[kCandidatesPerTile][kThreads];
shared uint sNearest[kCandidatesPerTile][kThreads];
shared uint sFarthestInverted[kCandidatesPerTile][kThreads];
shared uint sParts[kCandidatesPerTile][kThreads];
/// Before candidates are split: where they were listed.
shared uint sRanges[kCandidatesPerTile][kThreads];

/// Instants at which a surface's depths are looked at, at most.
const uint kDepthInstants = 8u;
/// By which a surface's depths are widened on both sides, bins.
const float kDepthMargin = 0.05f;

Candidate readCandidate(uint layer, uint tile, uint slot) {
    if (layer == kLastLayer) return uLast[tile].candidates[slot];
    if (layer == kSecondLayer) return uSecond[tile].candidates[slot];
    return uRaster[tile].candidates[slot];
}

void writeCandidate(uint layer, uint tile, uint slot, Candidate candidate) {
    if (layer == kLastLayer)
        uLast[tile].candidates[slot] = candidate;
    else if (layer == kSecondLayer)
        uSecond[tile].candidates[slot] = candidate;
    else
        uRaster[tile].candidates[slot] = candidate;
}

uvec2 readBins(uint layer, uint tile, uint slot) {
    uint at = 2u * slot;
    if (layer == kLastLayer) return ~uvec2(uLast[tile].ranges[at], uLast[tile].ranges[at + 1u]);
    if (layer == kSecondLayer) return ~uvec2(uSecond[tile].ranges[at], uSecond[tile].ranges[at + 1u]);
    return ~uvec2(uRaster[tile].ranges[at], uRaster[tile].ranges[at + 1u]);
}

void writeRange(uint layer, uint tile, uint slot, uint range) {
    if (layer == kLastLayer)
        uLast[tile].ranges[slot] = range;
    else if (layer == kSecondLayer)
        uSecond[tile].ranges[slot] = range;
    else
        uRaster[tile].ranges[slot] = range;
}

uint readParts(uint layer, uint tile, uint index) {
    if (layer == kLastLayer) return uLast[tile].parts[index];
    if (layer == kSecondLayer) return uSecond[tile].parts[index];
    return uRaster[tile].parts[index];
}

void writeParts(uint layer, uint tile, uint index, uint bits) {
    if (layer == kLastLayer)
        uLast[tile].parts[index] = bits;
    else if (layer == kSecondLayer)
        uSecond[tile].parts[index] = bits;
    else
        uRaster[tile].parts[index] = bits;
}

/// What candidates are sorted by: the sky is behind everything, and equals have one order.
uvec2 rankOf(uint key, uint nearest) { return uvec2(key == kSkyKey ? kNoKey : nearest, key); }

bool isBefore(uvec2 a, uvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// Moves a slot's candidate before those in lower slots that lie behind it.
void sink(uint slot, uint thread) {
    uint key = sKeys[slot][thread];
    uint nearest = sNearest[slot][thread];
    uint farthestInverted = sFarthestInverted[slot][thread];
    uint parts = sParts[slot][thread];
    uint range = sRanges[slot][thread];
    uvec2 rank = rankOf(key, nearest);
    [[dont_unroll]] for (; slot > 0u; --slot) {
        if (!isBefore(rank, rankOf(sKeys[slot - 1u][thread], sNearest[slot - 1u][thread]))) break;
        sKeys[slot][thread] = sKeys[slot - 1u][thread];
        sNearest[slot][thread] = sNearest[slot - 1u][thread];
        sFarthestInverted[slot][thread] = sFarthestInverted[slot - 1u][thread];
        sParts[slot][thread] = sParts[slot - 1u][thread];
        sRanges[slot][thread] = sRanges[slot - 1u][thread];
    }
    sKeys[slot][thread] = key;
    sNearest[slot][thread] = nearest;
    sFarthestInverted[slot][thread] = farthestInverted;
    sParts[slot][thread] = parts;
    sRanges[slot][thread] = range;
}

/// \return how many there are
uint readCandidates(uint layer, uint tile, uint thread) {
    uint end = 0u;
    [[dont_unroll]] for (; end < kCandidatesPerTile; ++end) {
        Candidate listed = readCandidate(layer, tile, end);
        if (listed.key == kNoKey) break;
        sKeys[end][thread] = listed.key;
        sNearest[end][thread] = listed.nearest;
        sFarthestInverted[end][thread] = listed.farthestInverted;
        sParts[end][thread] = readParts(layer, tile, end);
        sRanges[end][thread] = end;
        sink(end, thread);
    }
    return end;
}

/// Bounds the depth at which the tile sees, at any instant, a surface between two depths of the layer's
/// raster. At a place of the picture, depth at an instant is a linear function of depth in the raster.
/// kDepthMargin covers what a lens's places and the instants in between add.
/// \param inRaster least and greatest depth
/// \param depths bounds of the whole entity in the tile at any instant
vec2 boundSurface(
    LayerMotion layer, uint mover, vec2 origin, vec2 inRaster, vec2 depths, bool perspective
) {
    uint count = method.instantCount / (has(method, kHasLensPlaces) ? kLensSets : 1u);
    uint looks = min(count, kDepthInstants);
    vec2 bounds = vec2(3.0e38f, 0.0f);
    [[dont_unroll]] for (uint i = 0u; i < looks; ++i) {
        uint instant = looks > 1u ? i * (count - 1u) / (looks - 1u) : 0u;
        vec4 row = InstantMotionTable(layer.motions).motions[mover * count + instant].rasterFromInstant[2];
        if (row == vec4(0.0f)) continue;
        [[dont_unroll]] for (uint corner = 0u; corner < 4u; ++corner) {
            vec2 at = origin + float(kCandidateTilePx) * vec2(corner & 1u, corner >> 1u);
            float perDepth = perspective ? dot(row.xyz, vec3(at, 1.0f)) : row.z;
            float fixed_ = perspective ? row.w : dot(row.xyw, vec3(at, 1.0f));
            if (perDepth <= 0.0f) return depths; // something of it lies behind the camera
            vec2 seen = (inRaster - fixed_) / perDepth;
            bounds = vec2(min(bounds.x, seen.x), max(bounds.y, seen.y));
        }
    }
    bounds = vec2(max(bounds.x, depths.x), min(bounds.y, depths.y));
    return bounds.x <= bounds.y ? bounds : depths;
}

bool hasBit(uvec2 bits, uint bit) { return (bits[bit >> 5u] >> (bit & 31u) & 1u) != 0u; }

/// Makes a candidate of each run of bins of an entity that has gaps in between, as long as there are slots:
/// those of the least parallax share the last one.
/// \param slot of the entity \param end of all candidates \return the same with the new ones
uint splitCandidate(uint layer, uint tile, uint slot, uint end, vec2 origin, uint thread) {
    uvec2 bins = readBins(layer, tile, sRanges[slot][thread]);
    sRanges[slot][thread] = kAnyRange;
    // The highest bin of each run; one alone is the usual case.
    uvec2 highest = bins & ~uvec2(bins.x >> 1u | bins.y << 31u, bins.y >> 1u);
    if (bitCount(highest.x) + bitCount(highest.y) < 2) return end;
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    LayerMotion motion = getLayer(motions, layer);
    bool perspective = motions.value.isPerspective != 0u;
    uint key = sKeys[slot][thread];
    uint parts = sParts[slot][thread];
    float perAlong = parallaxOf(motion, key);
    vec2 depths = vec2(
        uintBitsToFloat(sNearest[slot][thread]), uintBitsToFloat(~sFarthestInverted[slot][thread])
    );
    [[dont_unroll]] while (highest != uvec2(0u)) {
        uint high = uint(highest.y != 0u ? 32 + findMSB(highest.y) : findMSB(highest.x));
        highest[high >> 5u] &= ~(1u << (high & 31u));
        bool isLast = highest == uvec2(0u) || end == kCandidatesPerTile;
        uint low = high;
        [[dont_unroll]] while (low > 0u && hasBit(bins, low - 1u)) --low;
        if (isLast) low = uint(bins.x != 0u ? findLSB(bins.x) : 32 + findLSB(bins.y));
        vec2 inRaster = depthsOfBins(
            float(low) - kDepthMargin, float(high + 1u) + kDepthMargin, perAlong, perspective
        );
        vec2 bounds =
            boundSurface(motion, findMover(motion, key), origin, inRaster, depths, perspective);
        sKeys[slot][thread] = key;
        sNearest[slot][thread] = floatBitsToUint(bounds.x);
        sFarthestInverted[slot][thread] = ~floatBitsToUint(bounds.y);
        sParts[slot][thread] = parts;
        sRanges[slot][thread] = rangeOfBins(low, high, perAlong, perspective);
        if (isLast) break;
        slot = end++;
    }
    return end;
}

/// \return how many there are
uint splitCandidates(uint layer, uint tile, uint count, vec2 origin, uint thread) {
    uint end = count;
    [[dont_unroll]] for (uint slot = 0u; slot < count; ++slot)
        end = splitCandidate(layer, tile, slot, end, origin, thread);
    if (end == count) return count;
    [[dont_unroll]] for (uint slot = 1u; slot < end; ++slot) sink(slot, thread);
    return end;
}

void writeCandidates(uint layer, uint tile, uint count, uint thread) {
    LayerMotion motion = getLayer(InstantMotionsRef(method.motions), layer);
    uint ranges = 0u;
    [[dont_unroll]] for (uint slot = 0u; slot < count; ++slot) {
        uint key = sKeys[slot][thread];
        uint mover = (key & kPartBit) != 0u ? kDeformedMover : findMover(motion, key);
        writeCandidate(
            layer, tile, slot,
            Candidate(key, sNearest[slot][thread], sFarthestInverted[slot][thread], mover)
        );
        if (sRanges[slot][thread] == kAnyRange) continue;
        writeRange(layer, tile, slot, sRanges[slot][thread]);
        ranges |= 1u << slot;
    }
    writeRange(layer, tile, kRangesMask, ranges);
}

/// From a bit for each part, by candidate, to a bit for each candidate, by part.
void transposeParts(uint layer, uint tile, uint count, uint thread) {
    [[dont_unroll]] for (uint part = 0u; part < min(method.instantCount, kExposureParts); ++part) {
        uint bits = 0u;
        [[dont_unroll]] for (uint slot = 0u; slot < count; ++slot)
            bits |= (~sParts[slot][thread] >> part & 1u) << slot;
        writeParts(layer, tile, part, bits);
    }
}

void prepareTile(uint layer, uint tile, vec2 origin) {
    uint thread = gl_LocalInvocationIndex;
    uint listed = readCandidates(layer, tile, thread);
    uint count = splitCandidates(layer, tile, listed, origin, thread);
    writeCandidates(layer, tile, count, thread);
    transposeParts(layer, tile, count, thread);
}

void main() {
    uvec2 tile = gl_GlobalInvocationID.xy;
    uvec2 tiles = countTiles(params.sizePx);
    if (any(greaterThanEqual(tile, tiles))) return;
    uint index = tile.y * tiles.x + tile.x;
    vec2 origin = vec2(tile * kCandidateTilePx);
    prepareTile(kRasterLayer, index, origin);
    if (has(method, kHasLastLayer)) prepareTile(kLastLayer, index, origin);
    if (has(method, kHasSecondLayer)) prepareTile(kSecondLayer, index, origin);
}
