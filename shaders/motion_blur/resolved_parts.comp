// SPDX-License-Identifier: MIT
// Finds the deforming parts (resolved_parts_shared.h) in a tile of a layer, and enters them in the
// lists of the tiles that may see them. A group takes a tile, one entity after the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#include "common/numeric.glsl"
#include "motion_blur/resolved.glsl"
#include "motion_blur/resolved_parts.glsl"

layout(constant_id = 0) const uint kLayer = kRasterLayer;

// Each thread takes several of the tile's pixels, as in resolved_candidates.comp.
layout(local_size_x = kGroupSize, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kThreadRows = kGroupSize; // of a group
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0) uniform usampler2D uSurface;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 4, scalar) readonly buffer DeformingTiles {
    DeformingHeader header;
    uint entries[];
} uDeforming;
layout(binding = 5, scalar) writeonly buffer Parts { TilePart uParts[]; };
layout(binding = 6) uniform usampler2D uWays;

#include "motion_blur/resolved_enter.glsl"

const uint kThreads = kGroupSize * kThreadRows;
const uint kPixels = kCandidateTilePx * kCandidateTilePx;
/// Sums of a fit: pixels; x, y; xx, xy, yy; then of each component of a way itself, by x and by y.
const uint kPlaceSums = 6u;
const uint kComponents = 6u;
const uint kSums = kPlaceSums + 3u * kComponents;
/// Deviation from which an entity is cut in two, pixels.
const float kMaxDeviationPx = 1.0f;
/// Largest half used, and the increment that rounds up.
const float kMaxHalf = 60000.0f;
const float kUp = 1.001f;
/// Greatest change of a part's ways per pixel.
const float kSteepestChange = 1024.0f;
/// Around the bounds of a part.
const float kPartMarginPx = 0.5f;

// Loops over pixels stay loops: each is in every part that is found, and compilers write them out.
shared uint sKeys[kPixels]; // kNoKey: nothing that deforms
shared float sDepths[kPixels];
shared uvec2 sWays[kPixels]; // packWay()
shared uint sNext;
shared float sSums[kGroupSize * kGroupSize][kSums];
shared float sTotals[kSums];
shared uint sNearest;
shared uint sFarthest;
shared int sLowX;
shared int sLowY;
shared int sHighX;
shared int sHighY;
shared uint sDeviations[3];
shared TilePart sParts[kPartsPerTile];
shared vec2 sPartDepths[kPartsPerTile];

/// From the tile's corner.
ivec2 placeOf(uint pixel) { return ivec2(pixel % kCandidateTilePx, pixel / kCandidateTilePx); }

uvec2 fetchWay(vec2 uv) {
    if (has(method, kHasWays)) return textureLod(uWays, uv, 0.0f).xy;
    vec2 motion = textureLod(uMotionDepth, uv, 0.0f).xy;
    return packWay(straightWay(motion, params.rasterTime));
}

void loadTile(uvec2 tile, LayerMotion layer) {
    uint lastKey = kNoKey;
    bool deforms = false;
    [[dont_unroll]] for (uint i = gl_LocalInvocationIndex; i < kPixels; i += kThreads) {
        uvec2 at = tile * kCandidateTilePx + uvec2(placeOf(i));
        sKeys[i] = kNoKey;
        if (any(greaterThanEqual(at, params.sizePx))) continue;
        vec2 uv = (vec2(at) + 0.5f) / vec2(params.sizePx); // texelFetch is slow on software devices
        uvec2 surface = textureLod(uSurface, uv, 0.0f).xy;
        uint key = keyOf(surface);
        if (key != lastKey) deforms = findMover(layer, key) == kDeformedMover;
        lastKey = key;
        if (!deforms) continue;
        uvec2 way = fetchWay(uv);
        if (way.x == kNoWay) continue;
        sKeys[i] = key;
        sDepths[i] = uintBitsToFloat(surface.x);
        sWays[i] = way;
    }
}

/// All threads of the group call it. \return the least key above `last`; kNoKey: there is none
uint findNextKey(uint last) {
    barrier();
    if (gl_LocalInvocationIndex == 0u) sNext = kNoKey;
    barrier();
    uint least = kNoKey;
    [[dont_unroll]] for (uint i = gl_LocalInvocationIndex; i < kPixels; i += kThreads)
        if (last == kNoKey || sKeys[i] > last) least = min(least, sKeys[i]);
    atomicMin(sNext, least);
    barrier();
    return sNext;
}

float componentOf(PixelWay way, uint component) {
    vec2 vector = component < 2u ? way.open : (component < 4u ? way.close : way.bend);
    return vector[component & 1u];
}

/// Which of the tile's pixels a part has: those of an entity whose way has a component above or not
/// above a limit.
struct Choice {
    uint key;
    uint component;
    float limit;
    int side; // 1: above, -1: not above, 0: all
};

bool isChosen(Choice choice, uint pixel) {
    if (sKeys[pixel] != choice.key) return false;
    if (choice.side == 0) return true;
    float value = componentOf(unpackWay(sWays[pixel]), choice.component);
    return (value > choice.limit) == (choice.side > 0);
}

void resetExtent() {
    sNearest = 0xFFFFFFFFu;
    sFarthest = 0u;
    sLowX = sLowY = 0x7FFFFFFF;
    sHighX = sHighY = -0x7FFFFFFF;
    for (uint i = 0u; i < 3u; ++i) sDeviations[i] = 0u;
}

/// Sums over the chosen pixels, and their extent.
void sumPixels(Choice choice) {
    barrier();
    if (gl_LocalInvocationIndex == 0u) resetExtent();
    barrier();
    float sums[kSums];
    for (uint i = 0u; i < kSums; ++i) sums[i] = 0.0f;
    vec2 depths = vec2(3.0e38f, 0.0f);
    ivec2 low = ivec2(0x7FFFFFFF);
    ivec2 high = ivec2(-0x7FFFFFFF);
    [[dont_unroll]] for (uint i = gl_LocalInvocationIndex; i < kPixels; i += kThreads) {
        if (!isChosen(choice, i)) continue;
        ivec2 place = placeOf(i);
        // From the tile's middle: small numbers, whose squares keep their digits.
        vec2 at = vec2(place) + 0.5f - 0.5f * float(kCandidateTilePx);
        sums[0] += 1.0f;
        sums[1] += at.x;
        sums[2] += at.y;
        sums[3] += at.x * at.x;
        sums[4] += at.x * at.y;
        sums[5] += at.y * at.y;
        PixelWay way = unpackWay(sWays[i]);
        for (uint component = 0u; component < kComponents; ++component) {
            float value = componentOf(way, component);
            uint first = kPlaceSums + 3u * component;
            sums[first] += value;
            sums[first + 1u] += value * at.x;
            sums[first + 2u] += value * at.y;
        }
        depths = vec2(min(depths.x, sDepths[i]), max(depths.y, sDepths[i]));
        low = min(low, place);
        high = max(high, place);
    }
    for (uint i = 0u; i < kSums; ++i) sSums[gl_LocalInvocationIndex][i] = sums[i];
    if (sums[0] > 0.0f) {
        atomicMin(sNearest, floatBitsToUint(depths.x));
        atomicMax(sFarthest, floatBitsToUint(depths.y));
        atomicMin(sLowX, low.x);
        atomicMin(sLowY, low.y);
        atomicMax(sHighX, high.x);
        atomicMax(sHighY, high.y);
    }
    barrier();
    // In one order, so that a frame has the same bits in each run.
    for (uint i = gl_LocalInvocationIndex; i < kSums; i += kThreads) {
        float total = 0.0f;
        [[dont_unroll]] for (uint thread = 0u; thread < kThreads; ++thread) total += sSums[thread][i];
        sTotals[i] = total;
    }
    barrier();
}

/// The matrix of the fits' normal equations, about the mean place.
struct Spread {
    vec2 centre;
    float xx;
    float xy;
    float yy;
};

Spread findSpread() {
    float n = sTotals[0];
    vec2 centre = vec2(sTotals[1], sTotals[2]) / n;
    // Half a pixel's square more on both axes: few pixels, or pixels in one line, lean to a shift.
    return Spread(
        centre, sTotals[3] - n * centre.x * centre.x + 0.5f * n,
        sTotals[4] - n * centre.x * centre.y, sTotals[5] - n * centre.y * centre.y + 0.5f * n
    );
}

/// Change of one component by x and y.
vec2 fitChange(Spread spread, uint component) {
    uint first = kPlaceSums + 3u * component;
    vec2 by = vec2(sTotals[first + 1u], sTotals[first + 2u]) - sTotals[first] * spread.centre;
    float determinant = spread.xx * spread.yy - spread.xy * spread.xy;
    vec2 change =
        vec2(by.x * spread.yy - by.y * spread.xy, by.y * spread.xx - by.x * spread.xy) / determinant;
    // A steeper fit is useless: the deviation covers the remainder.
    return clamp(change, -kSteepestChange, kSteepestChange);
}

/// \param component the vector's first
PartVector fitVector(Spread spread, uint component) {
    uint first = kPlaceSums + 3u * component;
    return PartVector(
        vec2(sTotals[first], sTotals[first + 3u]) / sTotals[0],
        uvec2(
            packHalf2x16(fitChange(spread, component)), packHalf2x16(fitChange(spread, component + 1u))
        )
    );
}

/// By least squares, from the sums: every thread for itself.
TilePart fitPart(Choice choice, uvec2 tile) {
    Spread spread = findSpread();
    ivec2 corner = ivec2(tile * kCandidateTilePx);
    TilePart part;
    part.key = choice.key | uint(sHighX - sLowX) << kPartWidthShift |
               uint(sHighY - sLowY) << kPartHeightShift;
    part.corner = uint(corner.x + sLowX) | uint(corner.y + sLowY) << 16u;
    part.centre = vec2(corner) + 0.5f * float(kCandidateTilePx) + spread.centre;
    part.deviations = uvec2(0u);
    part.open = fitVector(spread, 0u);
    part.close = fitVector(spread, 2u);
    part.bend = fitVector(spread, 4u);
    return part;
}

/// Greatest deviations of a chosen pixel's way from the fits; after sumPixels().
vec3 measureDeviations(Choice choice, TilePart part, uvec2 tile) {
    vec3 greatest = vec3(0.0f);
    [[dont_unroll]] for (uint i = gl_LocalInvocationIndex; i < kPixels; i += kThreads) {
        if (!isChosen(choice, i)) continue;
        vec2 from = vec2(tile * kCandidateTilePx) + vec2(placeOf(i)) + 0.5f - part.centre;
        PixelWay way = unpackWay(sWays[i]);
        vec3 off = vec3(
            distance(way.open, vectorAt(part.open, from)),
            distance(way.close, vectorAt(part.close, from)),
            distance(way.bend, vectorAt(part.bend, from))
        );
        greatest = max(greatest, off);
    }
    for (uint i = 0u; i < 3u; ++i) atomicMax(sDeviations[i], floatBitsToUint(greatest[i]));
    barrier();
    return vec3(
        uintBitsToFloat(sDeviations[0]), uintBitsToFloat(sDeviations[1]),
        uintBitsToFloat(sDeviations[2])
    );
}

/// All threads of the group call it.
/// \return whether the choice has pixels; their part is sParts[index] then
bool findPart(Choice choice, uvec2 tile, uint index) {
    sumPixels(choice);
    if (sTotals[0] == 0.0f) return false;
    TilePart part = fitPart(choice, tile);
    vec3 off = min(measureDeviations(choice, part, tile), kMaxHalf);
    // A little more than it is: halves round.
    part.deviations = uvec2(packHalf2x16(off.xy * kUp), packHalf2x16(vec2(off.z * kUp, 0.0f)));
    if (gl_LocalInvocationIndex == 0u) {
        sParts[index] = part;
        sPartDepths[index] = vec2(uintBitsToFloat(sNearest), uintBitsToFloat(sFarthest));
    }
    barrier();
    return true;
}

/// Where an entity is cut: at the middle of the component of its ways to open and close that varies
/// most.
Choice findCut(uint key) {
    // The fit's sums are no longer needed: bounds of the ways take their place.
    barrier();
    vec4 low = vec4(3.0e38f);
    vec4 high = vec4(-3.0e38f);
    [[dont_unroll]] for (uint i = gl_LocalInvocationIndex; i < kPixels; i += kThreads) {
        if (sKeys[i] != key) continue;
        PixelWay way = unpackWay(sWays[i]);
        low = min(low, vec4(way.open, way.close));
        high = max(high, vec4(way.open, way.close));
    }
    uint thread = gl_LocalInvocationIndex;
    for (uint i = 0u; i < 4u; ++i) {
        sSums[thread][i] = low[i];
        sSums[thread][i + 4u] = high[i];
    }
    barrier();
    uint widest = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        [[dont_unroll]] for (uint other = 0u; other < kThreads; ++other) {
            low[i] = min(low[i], sSums[other][i]);
            high[i] = max(high[i], sSums[other][i + 4u]);
        }
        if (high[i] - low[i] > high[widest] - low[widest]) widest = i;
    }
    return Choice(key, widest, 0.5f * (low[widest] + high[widest]), -1);
}

/// Greatest deviation of the part at any shutter time, about.
float deviationOf(TilePart part) {
    vec3 off = vec3(unpackHalf2x16(part.deviations.x), unpackHalf2x16(part.deviations.y).x);
    return max(max(off.x, off.y), 0.5f * (off.x + off.y) + off.z);
}

/// \return how many parts the entity has
uint findPartsOf(uint key, uvec2 tile, uint index) {
    Choice choice = Choice(key, 0u, 0.0f, 0);
    uint count = 0u;
    // The whole, and then both sides of a cut.
    [[dont_unroll]] for (uint step_ = 0u; step_ < 3u; ++step_) {
        if (step_ == 1u) {
            bool isLast = index + 1u == kPartsPerTile;
            if (isLast || deviationOf(sParts[index]) <= kMaxDeviationPx) return 1u;
            choice = findCut(key);
            count = 0u;
        }
        if (step_ == 2u) choice.side = 1;
        if (findPart(choice, tile, index + count)) ++count;
    }
    return count;
}

/// \param isFull the tile has more
/// \return how many parts of it are found
uint findParts(uvec2 tile, out bool isFull) {
    uint count = 0u;
    isFull = false;
    for (uint key = findNextKey(kNoKey); key != kNoKey; key = findNextKey(key)) {
        if (count == kPartsPerTile) {
            isFull = true;
            break;
        }
        count += findPartsOf(key, tile, count);
    }
    return count;
}

void enterPart(uint index, uint id, uint sample_) {
    TilePart part = sParts[index];
    SeenBox box = kNoBox;
    for (uint set = 0u; set < method.setCount; ++set) {
        uint instant = sample_ * method.setCount + set;
        float s = timeOf(InstantMotionsRef(method.motions), instant);
        vec4 bounds = boundsOf(part, wayAt(part, s));
        vec2 low = bounds.xy - kPartMarginPx;
        vec2 high = bounds.zw + kPartMarginPx;
        widenByLens(instant, sPartDepths[index], low, high);
        addBox(instant, low, high, sPartDepths[index], box);
    }
    if (box.parts != 0u) enterBox(kPartBit | id, box, uvec2(0u));
}

void main() {
    uint listed = gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x;
    if (listed >= uDeforming.header.count) return;
    uvec2 tile = uvec2(uDeforming.entries[listed] & 0xFFFFu, uDeforming.entries[listed] >> 16u);
    loadTile(tile, getLayer(InstantMotionsRef(method.motions), kLayer));
    bool isFull;
    uint count = findParts(tile, isFull);
    uint tileIndex = tile.y * countTiles(params.sizePx).x + tile.x;
    if (isFull && gl_LocalInvocationIndex == 0u) noteUnlistedSource(tileIndex, kLayer);
    uint first = firstPartOf(tileIndex);
    if (count < kPartsPerTile && gl_LocalInvocationIndex == 0u) uParts[first + count].key = kNoKey;
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < count; i += kThreads) {
        uParts[first + i] = sParts[i];
        // Parts in the tile now must be candidates, even if they are there at no instant.
        if (kLayer == kRasterLayer)
            enter(tileIndex, kPartBit | (first + i), sPartDepths[i], 0u, uvec2(0u));
    }
    for (uint i = gl_LocalInvocationIndex; i < count * params.sampleCount; i += kThreads) {
        uint index = i / params.sampleCount;
        enterPart(index, first + index, i - index * params.sampleCount);
    }
}
