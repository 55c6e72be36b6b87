// SPDX-License-Identifier: MIT
// Finds the samples of a block's pixels for all of them together. If they can see only one plane of
// this frame's raster at an instant, sample positions are an affine map and no search is needed. At
// other instants, candidates are dropped that this frame's raster does not show where the block
// would see them.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/block_plane.glsl"
#include "motion_blur/pixel_ray.glsl"
#include "motion_blur/resolved_lens.glsl"
#include "motion_blur/resolved_parts.glsl"

layout(constant_id = 0) const bool kSortsUniform = true; // false: all that moves is in one list
layout(constant_id = 1) const bool kHasParts = false;     // something deforms in this frame's raster
layout(constant_id = 2) const uint kBlocksAcross = kGroupSize; // blocks of a group, across and down
layout(constant_id = 3) const bool kHasLens = false; // each instant has a place of the lens
/// Threads of a block, which share its instants.
const uint kLanes = kGroupSize * kGroupSize / (kBlocksAcross * kBlocksAcross);

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0, scalar) readonly buffer RasterCandidates { TileCandidates uRaster[]; };
layout(binding = 1, scalar) readonly buffer LastCandidates { TileCandidates uLast[]; };
layout(binding = 2, scalar) readonly buffer Planes { BlockPlane uPlanes[]; };
layout(binding = 3, scalar) writeonly buffer BlockSampleBuffer { BlockSample uBlockSamples[]; };
layout(binding = 4, scalar) buffer BlockLists {
    BlockHeader header;
    uint entries[];
} uBlocks;
layout(binding = 5, scalar) buffer Arguments { DispatchArguments uArguments[kListCount]; };
layout(binding = 6, scalar) readonly buffer SecondCandidates { TileCandidates uSecond[]; };
layout(binding = 7, scalar) readonly buffer Parts { TilePart uParts[]; };
layout(binding = 8, scalar) buffer GeneralBlocks {
    BlockHeader header;
    uint entries[];
} uGeneral;
layout(binding = 9, scalar) buffer GeneralArguments { DispatchArguments uGeneralArguments; };
layout(binding = 10, scalar) buffer Counters { ResolvedCounters uCounters; };

#include "motion_blur/resolved_crowds.glsl"

/// Margin around sample positions for linear filtering.
const float kFetchMarginPx = 1.0f;
/// By how much farther inside another layer has a place beyond the border to be searched.
const float kNearerBorderPx = 1.0f;
/// Most blocks of the raster, across and down, that a block may sample.
const int kMaxBlocksAcross = kHasLens ? 6 : 4;
const float kFarAway = 1.0e4f;
/// Inverse of the depth that the sky's places are taken at, 1/metre.
const float kMinAlong = 1.0e-6f;
const uint kMinInstants = 6u;
/// Motion per instant, in pixels, from which pixels have individual instants, and the further
/// motion until these are spread over the whole interval. Copies of an edge that lie closer are not
/// visible, and noise would only be an error. Above 1/2, or blocks with noise would take fewer
/// instants than there are.
const float kNoiseFromPx = 2.0f;
const float kNoiseRampPx = 2.0f;
// With a lens.
/// How much a plane's circle of confusion may grow per pixel.
const float kMaxSlopeOfLens = 0.5f;
/// Distance between samples from which pixels have individual sets, which a filter then averages.
const float kLensNoiseFromPx = 1.0f;
/// Reach within which what a block sees counts as in focus and still, pixels.
const float kStillReachPx = 0.125f;
/// Way up to which a few samples do.
const float kSharedWayPx = 0.5f;
/// Instants at which a way is measured: what spins is seldom where it was at all of them.
const uint kWayInstants = 5u;

/// Data shared by a tile's candidates in a part of the exposure.
struct Shared {
    uint mover;  // kNoMover: nothing
    vec2 alongs; // least and greatest of all, at the instant
};

/// Least and greatest at the instant.
vec2 alongsOf(Candidate candidate, bool perspective) {
    float nearest = alongOf(uintBitsToFloat(candidate.nearest), perspective);
    float farthest = alongOf(uintBitsToFloat(~candidate.farthestInverted), perspective);
    return vec2(min(nearest, farthest), max(nearest, farthest));
}

Shared findShared(uint tile, uint slots, bool perspective) {
    Shared seen = Shared(kNoMover, vec2(3.0e38f, 0.0f));
    for (; slots != 0u; slots &= slots - 1u) {
        Candidate candidate = uRaster[tile].candidates[findLSB(slots)];
        vec2 alongs = alongsOf(candidate, perspective);
        uint mover = candidate.mover;
        if (perspective && mover == kSkyMover) {
            mover = kWorldMover;
            alongs = vec2(0.0f);
        }
        if (seen.mover != kNoMover && mover != seen.mover)
            return Shared(kNoMover, vec2(0.0f));
        seen.mover = mover;
        seen.alongs = vec2(min(seen.alongs.x, alongs.x), max(seen.alongs.y, alongs.y));
    }
    if (seen.mover == kDeformedMover || seen.mover == kSkyMover) seen.mover = kNoMover;
    return seen;
}

/// Bounds of a block's sample positions.
struct Reach {
    bool isInFront; // of the camera, all of it
    vec2 low;
    vec2 high;
};

/// \param corners of the block at the instant, or beyond it, pixels: x and y least and greatest
Reach findReach(vec4 rasterFromInstant[3], vec4 corners, vec2 alongs, bool perspective) {
    Reach reach = Reach(true, vec2(3.0e38f), vec2(-3.0e38f));
    for (uint corner = 0u; corner < 4u; ++corner) {
        vec2 x = vec2(
            (corner & 1u) != 0u ? corners.z : corners.x, (corner & 2u) != 0u ? corners.w : corners.y
        );
        PixelRay ray = findRay(rasterFromInstant, x, perspective);
        for (uint end = 0u; end < 2u; ++end) {
            vec3 point = ray.base + ray.slope * alongs[end];
            reach.isInFront = reach.isInFront && (!perspective || point.z > kMinDepthRatio);
            vec2 place = projectPicture(point, perspective);
            reach.low = min(reach.low, place);
            reach.high = max(reach.high, place);
        }
    }
    reach.low -= kFetchMarginPx;
    reach.high += kFetchMarginPx;
    return reach;
}

/// The picture goes on as it ends, as where it is searched (withinBorder()).
void keepInside(inout Reach reach) {
    vec2 last = vec2(params.sizePx) - 0.5f;
    reach.low = clamp(reach.low, vec2(0.0f), last);
    reach.high = clamp(reach.high, vec2(0.0f), last);
}

/// Whether another layer may show what lies beyond the border of this frame's raster.
/// \param reach in this frame's raster
bool isReachedByOther(
    Reach reach, uint index, uint mover, uint instant, vec4 corners, vec2 alongs, bool perspective
) {
    LayerMotion layer = getLayer(InstantMotionsRef(method.motions), index);
    InstantMotion motion = motionAt(method, kHasLens, layer, mover, instant);
    if (motion.rasterFromInstant[2] == vec4(0.0f)) return false;
    Reach other = findReach(motion.rasterFromInstant, corners, alongs, perspective);
    bool isReached = false;
    for (int axis = 0; axis < 2; ++axis) {
        isReached = isReached || (reach.low[axis] < 0.0f &&
                                  other.low[axis] > reach.low[axis] + kNearerBorderPx);
        isReached = isReached || (reach.high[axis] >= float(params.sizePx[axis]) &&
                                  other.high[axis] < reach.high[axis] - kNearerBorderPx);
    }
    return isReached;
}

/// Screen bounds of the block at the instant, over all lens sets and all surfaces between two inverse
/// depths, pixels: least x and y, greatest x and y. Without a lens, the block itself.
vec4 cornersOf(ivec2 block, uint instant, vec2 alongs) {
    vec2 first = vec2(block) * float(kGroupSize);
    vec4 corners = vec4(first, first + float(kGroupSize));
    if (!kHasLens) return corners;
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    LensReach reach = reachOf(motions, instant / kLensSets);
    vec4 lens = lensOf(motions, instant);
    vec4 margins = vec4(0.0f);
    for (uint end = 0u; end < 2u; ++end) {
        vec2 own = lens.xy + lens.zw * alongs[end];
        vec4 others = lensShifts(reach, vec2(alongs[end]));
        margins = vec4(min(margins.xy, own - others.zw), max(margins.zw, own - others.xy));
    }
    return corners + margins;
}

/// Bound on how much farther any set's lens offset moves a point at 1 m than the middle set's, pixels.
float reachOfSets(uint instant) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    LensReach reach = reachOf(motions, instant / kLensSets);
    vec2 place = lensOf(motions, instant).zw;
    return max(length(max(abs(reach.low), abs(reach.high))) - length(place), 0.0f);
}

uvec2 countBlocks() { return (params.sizePx + kGroupSize - 1u) / kGroupSize; }

BlockPlane getPlane(ivec2 block) { return uPlanes[block.y * int(countBlocks().x) + block.x]; }

vec2 centreOf(ivec2 block) { return (vec2(block) + 0.5f) * float(kGroupSize); }

/// Depth at the instant of what a plane shows at a place of the raster.
/// \param centre of its block, pixels
float depthOf(BlockPlane plane, vec2 centre, InstantMotion motion, vec2 place) {
    float along = plane.along + dot(plane.slope, place - centre);
    vec4 point = pictureSpace(place, 1.0f / max(along, kMinAlong), true);
    return dot(motion.instantFromRaster[2], point);
}

/// From the depths that the middle set sees a pixel to the right and below, PlaneMap::slope.
/// \return false: by some place of the lens the plane folds over, or nearly
bool findSlope(uint instant, inout PlaneMap map) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    vec2 perPixel = vec2(alongOf(map.slope.x, true), alongOf(map.slope.y, true)) -
                    alongOf(map.depth, true);
    map.slope = perPixel / (1.0f - dot(lensOf(motions, instant).zw, perPixel));
    LensReach reach = reachOf(motions, instant / kLensSets);
    float widest = length(max(abs(reach.low), abs(reach.high)));
    // Written so that NaN is a fold.
    return length(map.slope) * widest <= kMaxSlopeOfLens;
}

/// \return the block's sample positions at the instant; isAffine: it can see only one plane
PlaneMap lookAt(
    ivec2 block, uint mover, vec2 alongs, InstantMotion motion, uint instant, bool perspective
) {
    PlaneMap none;
    none.isAffine = false;
    if (motion.instantFromRaster[2] == vec4(0.0f)) return none;
    vec4 corners = cornersOf(block, instant, alongs);
    Reach reach = findReach(motion.rasterFromInstant, corners, alongs, perspective);
    if (kHasLens) {
        [[dont_unroll]] for (uint layer = kLastLayer; layer <= kSecondLayer; ++layer)
            if (has(method, layer == kLastLayer ? kHasLastLayer : kHasSecondLayer) &&
                isReachedByOther(reach, layer, mover, instant, corners, alongs, perspective))
                return none;
        keepInside(reach);
    }
    bool isInside = all(greaterThanEqual(reach.low, vec2(0.0f))) &&
                    all(lessThan(reach.high, vec2(params.sizePx)));
    if (!reach.isInFront || !isInside) return none;
    ivec2 low = ivec2(reach.low) / int(kGroupSize);
    ivec2 high = ivec2(reach.high) / int(kGroupSize);
    if (any(greaterThanEqual(high - low, ivec2(kMaxBlocksAcross)))) return none;
    ivec2 middle = (low + high) / 2;
    BlockPlane plane = getPlane(middle);
    if (plane.mover != mover) return none;
    PlaneMap map =
        mapPlane(motion.instantFromRaster, plane, centreOf(middle), centreOf(block), perspective);
    if (!map.isAffine) return none;
    if (kHasLens) map.pxPerAlong += reachOfSets(instant);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            BlockPlane other = getPlane(ivec2(x, y));
            float gap = planeGap(plane, centreOf(middle), other, centreOf(ivec2(x, y)));
            // Written so that NaN is not uniform.
            bool isOne = other.mover == mover && gap * map.pxPerAlong <= params.uniformMotionPx;
            if (!isOne) return none;
        }
    if (kHasLens) {
        map.depth = depthOf(plane, centreOf(middle), motion, map.place);
        map.slope = vec2(
            depthOf(plane, centreOf(middle), motion, map.place + map.perX),
            depthOf(plane, centreOf(middle), motion, map.place + map.perY)
        );
        if (!findSlope(instant, map)) return none;
        map.place += shiftForInterpolation(
            InstantMotionsRef(method.motions), instant, alongOf(map.depth, true)
        );
    }
    return map;
}

/// \return whether this frame's raster shows the candidate where the block would see it, by the
/// keys of blocks
bool isShown(
    ivec2 block, Candidate candidate, InstantMotion motion, uint instant, bool perspective
) {
    uint bit = keyBit(candidate.key);
    // The present occluder of the rest is searched at every instant: surfaces next to it become
    // visible.
    if ((getPlane(block).keys & bit) != 0u) return true;
    if (motion.rasterFromInstant[2] == vec4(0.0f)) return false;
    vec2 alongs = alongsOf(candidate, perspective);
    vec2 lensAlongs = candidate.key == kSkyKey ? vec2(0.0f) : alongs;
    Reach reach = findReach(
        motion.rasterFromInstant, cornersOf(block, instant, lensAlongs), alongs, perspective
    );
    if (!reach.isInFront) return true;
    if (kHasLens) keepInside(reach);
    vec2 size = vec2(params.sizePx);
    if (any(lessThan(reach.high, vec2(0.0f))) || any(greaterThanEqual(reach.low, size)))
        return false;
    ivec2 low = ivec2(max(reach.low, vec2(0.0f))) / int(kGroupSize);
    ivec2 high = ivec2(min(reach.high, size - 1.0f)) / int(kGroupSize);
    if (any(greaterThanEqual(high - low, ivec2(kMaxBlocksAcross)))) return true;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            if ((getPlane(ivec2(x, y)).keys & bit) != 0u) return true;
    return false;
}

#include "motion_blur/resolved_part_looks.glsl"

/// Candidates that the block may see.
uint findShown(
    ivec2 block, uint tile, uint slots, uint instant, LayerMotion layer, bool perspective
) {
    uint shown = slots;
    for (; slots != 0u; slots &= slots - 1u) {
        uint slot = uint(findLSB(slots));
        Candidate candidate = uRaster[tile].candidates[slot];
        bool isSeen;
        if (kHasParts && candidate.mover == kDeformedMover)
            isSeen = isPartShown(block, candidate.key, instant);
        else
            isSeen = isShown(
                block, candidate,
                motionAt(method, kHasLens, layer, candidate.mover, instant), instant, perspective
            );
        if (!isSeen) shown &= ~(1u << slot);
    }
    return shown;
}

Candidate getCandidate(uint layer, uint tile, uint slot) {
    if (layer == kLastLayer) return uLast[tile].candidates[slot];
    if (layer == kSecondLayer) return uSecond[tile].candidates[slot];
    return uRaster[tile].candidates[slot];
}

/// Motion of the block's sample positions in the layer over the exposure, by the fastest candidate:
/// at a middle depth, at a few instants. Pixels.
/// \param lane whose share of the candidates counts
float measureWay(uint index, ivec2 block, uint tile, bool perspective, uint lane) {
    LayerMotion layer = getLayer(InstantMotionsRef(method.motions), index);
    float longest = 0.0f;
    for (uint slot = lane; slot < kCandidatesPerTile; slot += kLanes) {
        Candidate candidate = getCandidate(index, tile, slot);
        if (candidate.key == kNoKey) break;
        if (candidate.mover == kDeformedMover) return kFarAway;
        vec2 alongs = alongsOf(candidate, perspective);
        vec2 before = vec2(0.0f);
        float way = 0.0f;
        for (uint i = 0u; i < kWayInstants; ++i) {
            uint instant = i * (method.instantCount - 1u) / (kWayInstants - 1u);
            InstantMotion motion = motionAt(method, false, layer, candidate.mover, instant);
            if (motion.rasterFromInstant[2] == vec4(0.0f)) return kFarAway;
            PixelRay ray = findRay(motion.rasterFromInstant, centreOf(block), perspective);
            vec2 place = placeOn(ray, 0.5f * (alongs.x + alongs.y), perspective);
            if (i > 0u) way += distance(place, before);
            before = place;
        }
        longest = max(longest, way);
    }
    return longest;
}

/// Spread of a block's samples of one surface by lens and motion.
struct Spread {
    float way;     // length of a straight path with the same sample spacing, pixels
    float reach;   // farthest from the block itself, pixels
    float leastPx; // least diameter of a circle of confusion
};

/// Data shared by the lookups of one block.
struct BlockSearch {
    ivec2 block;
    uint tile;
    uint firstSample; // index of the first
    uint parts; // partsPerInstant()
    bool perspective;
    LayerMotion layer;
};

/// From a place of the block to where it samples in the course of the exposure, at a few instants, by all
/// places of the lens: bounds, x and y least and greatest.
vec4 boundPlacesOf(BlockSearch search, uint mover, float along, vec2 x) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    uint samples = params.sampleCount;
    LensReach reach = reachOf(motions, samples);
    float lensAlong = mover == kSkyMover ? 0.0f : along;
    vec4 bounds = vec4(0.0f);
    for (uint i = 0u; i < kWayInstants; ++i) {
        uint sample_ = i * (samples - 1u) / (kWayInstants - 1u);
        InstantMotion motion =
            InstantMotionTable(search.layer.motions).motions[mover * samples + sample_];
        if (motion.rasterFromInstant[2] == vec4(0.0f))
            return vec4(-kFarAway, -kFarAway, kFarAway, kFarAway);
        PixelRay ray = findRay(motion.rasterFromInstant, x, search.perspective);
        vec2 from = placeOn(ray, along, search.perspective) - x;
        // A sample's own places may lie to one side of the lens.
        reach.inverseFocus = reachOf(motions, sample_).inverseFocus;
        vec4 shifts = lensShifts(reach, vec2(lensAlong));
        bounds = vec4(min(bounds.xy, from - shifts.zw), max(bounds.zw, from - shifts.xy));
    }
    return bounds;
}

/// For the block's centre or, if that sees itself, for three corners, which also detect rotation
/// about the centre.
vec4 boundPlaces(BlockSearch search, uint mover, float along) {
    vec2 centre = centreOf(search.block);
    vec4 bounds = boundPlacesOf(search, mover, along, centre);
    if (max(max(-bounds.x, -bounds.y), max(bounds.z, bounds.w)) > kStillReachPx) return bounds;
    for (uint corner = 0u; corner < 3u; ++corner) {
        vec2 side = vec2(corner & 1u, corner >> 1u) * 2.0f - 1.0f;
        vec4 there = boundPlacesOf(search, mover, along, centre + side * kHalfBlockPx);
        bounds = vec4(min(bounds.xy, there.xy), max(bounds.zw, there.zw));
    }
    return bounds;
}

/// Minimum diameter of the circles of confusion between the candidate's depths, pixels.
float leastConfusion(Candidate candidate) {
    if (candidate.key == kSkyKey) return confusionAt(InstantMotionsRef(method.motions), kFarAway);
    vec2 confusion = InstantMotionsRef(method.motions).value.confusion;
    float nearest = confusion.x - confusion.y / max(uintBitsToFloat(candidate.nearest), kMinDepth);
    float farthest =
        confusion.x - confusion.y / max(uintBitsToFloat(~candidate.farthestInverted), kMinDepth);
    return nearest * farthest <= 0.0f ? 0.0f : 2.0f * min(abs(nearest), abs(farthest));
}

/// By this frame's raster, which is all that is seen where nothing is out of place.
/// \param lane whose share of the candidates counts
Spread measureSpread(BlockSearch search, uint lane) {
    Spread spread = Spread(0.0f, 0.0f, kFarAway);
    for (uint slot = lane; slot < kCandidatesPerTile; slot += kLanes) {
        Candidate candidate = uRaster[search.tile].candidates[slot];
        if (candidate.key == kNoKey) break;
        spread.leastPx = min(spread.leastPx, leastConfusion(candidate));
        vec2 alongs = alongsOf(candidate, search.perspective);
        for (uint end = 0u; end < 2u; ++end) {
            vec4 bounds = vec4(-kFarAway, -kFarAway, kFarAway, kFarAway);
            if (candidate.mover != kDeformedMover)
                bounds = boundPlaces(search, candidate.mover, alongs[end]);
            vec2 size = bounds.zw - bounds.xy;
            float area = size.x * size.y * float(params.sampleCount);
            spread.way = max(spread.way, max(max(size.x, size.y), sqrt(area)));
            vec2 farthest = max(-bounds.xy, bounds.zw);
            spread.reach = max(spread.reach, max(farthest.x, farthest.y));
        }
    }
    return spread;
}

/// With a lens: how the places at which other sets sample a plane differ from the middle set's.
/// \param map at the instant
BlockSample findChange(uint sample_, PlaneMap map) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    float along = alongOf(map.depth, true);
    vec2 confusion = motions.value.confusion;
    float share = 1.0f - shareForInterpolation(abs(confusion.x - confusion.y * along));
    float focus = reachOf(motions, sample_).inverseFocus;
    return BlockSample(vec2(share * (focus - along), 0.0f), packHalf2x16(map.slope), 0u);
}

/// Finds and stores the block sample of one instant. \return where the block samples, if that is a plane
PlaneMap findBlockSample(BlockSearch search, uint instant) {
    uint slots = uRaster[search.tile].parts[partOf(instant, search.parts)];
    Shared seen = findShared(search.tile, slots, search.perspective);
    // Static surfaces are not candidates: they may hide parts of movers.
    if (search.layer.isStatic != 0u && getPlane(search.block).mover != seen.mover)
        seen.mover = kNoMover;
    PlaneMap map;
    map.isAffine = false;
    if (seen.mover != kNoMover) {
        InstantMotion motion = motionAt(method, kHasLens, search.layer, seen.mover, instant);
        map = lookAt(
            search.block, seen.mover, seen.alongs, motion, instant, search.perspective
        );
    }
    uint shown = 0u;
    if (!map.isAffine) {
        shown =
            findShown(search.block, search.tile, slots, instant, search.layer, search.perspective);
        if (kHasParts)
            map = lookAtParts(
                search.block, search.tile, shown, instant, search.layer.isStatic != 0u
            );
    }
    BlockSample blockSample = BlockSample(map.place, packHalf2x16(map.perX), packHalf2x16(map.perY));
    if (!map.isAffine) blockSample = BlockSample(vec2(0.0f), kSearchedBlock, shown);
    if (!kHasLens) {
        uBlockSamples[search.firstSample + instant] = blockSample;
        return map;
    }
    uint index = search.firstSample + 2u * (instant / kLensSets);
    uBlockSamples[index] = blockSample;
    if (map.isAffine) uBlockSamples[index + 1u] = findChange(instant / kLensSets, map);
    return map;
}

/// How a block is to be resolved.
struct Found {
    uint instants;  // how many each pixel takes
    float noise;    // how much of it, [0, 1]
    bool isUniform; // it sees a plane at each instant
    bool isStatic;   // it sees itself at each instant
    float leastPx;  // Spread::leastPx
};

/// \param way motion of the block's sample positions over the exposure, pixels
void chooseInstants(float way, inout Found found) {
    // About one for each pixel of the way, if that is few enough to leave some out evenly.
    found.instants = uint(min(way, kFarAway)) + kMinInstants;
    if (2u * found.instants > params.sampleCount) found.instants = params.sampleCount;
    float distancePx = way / float(params.sampleCount);
    found.noise = 0.0f;
    if (method.setCount > 1u) found.noise = saturate((distancePx - kNoiseFromPx) / kNoiseRampPx);
}

/// Whether pixels of the block show two surfaces (fit planes).
bool hasEdges(BlockSearch search) { return getPlane(search.block).keys == ~0u; }

/// With a lens: the samples of one set are spread evenly over it in their order, so that none are left out
/// but where all of them see the same.
void chooseSets(Spread spread, inout Found found) {
    found.isStatic = spread.reach <= kStillReachPx;
    found.instants = spread.way <= kSharedWayPx ? kMinInstants : params.sampleCount;
    found.instants = min(found.instants, params.sampleCount);
    found.noise = spread.way > kLensNoiseFromPx * float(params.sampleCount) ? 1.0f : 0.0f;
    found.leastPx = spread.leastPx;
}

/// Motion of the block's sample positions, over all layers.
float measureWays(BlockSearch search, uint lane) {
    float way = measureWay(kRasterLayer, search.block, search.tile, search.perspective, lane);
    if (has(method, kHasLastLayer))
        way = max(way, measureWay(kLastLayer, search.block, search.tile, search.perspective, lane));
    if (has(method, kHasSecondLayer))
        way = max(
            way, measureWay(kSecondLayer, search.block, search.tile, search.perspective, lane)
        );
    return way;
}

/// Sample positions of a block over the exposure.
struct Course {
    uint planes; // instants at which it sees one
    vec2 last;   // place
    float way;   // pixels
};

void addPlace(vec2 place, inout Course course) {
    ++course.planes;
    if (course.planes > 1u) course.way += distance(place, course.last);
    course.last = place;
}

// Data exchanged by the lanes of a block, by block of the group. A lane that is alone needs none of
// it.
const uint kMaxBlocks = kGroupSize * kGroupSize / 4u;
shared vec2 sPlaces[kMaxBlocks][kMaxBlockSamples];
shared uint sIsPlane[kMaxBlocks]; // a bit for each instant
shared uint sLongest[kMaxBlocks]; // bits of measureWays()
shared uint sIsMixed[kMaxBlocks];
shared uint sReach[kMaxBlocks];   // bits of Spread::reach
shared uint sLeast[kMaxBlocks];   // bits of Spread::leastPx

/// If pixels take individual sets: finds the lookups of the sets other than the middle one, too.
/// All lanes of a group call it.
Found withOwnSets(BlockSearch search, Found found, uint block, uint lane, bool isWanted) {
    uint middle = middleSet(method);
    if (!kHasLens && isWanted && found.noise != 0.0f)
        for (uint instant = lane; instant < method.instantCount; instant += kLanes)
            if (instant % method.setCount != middle && !findBlockSample(search, instant).isAffine)
                found.isUniform = false;
    if (kLanes > 1u) {
        if (!found.isUniform) sIsMixed[block] = 1u;
        barrier();
        found.isUniform = sIsMixed[block] == 0u;
    }
    return found;
}

/// Over all candidates of a block. All lanes of a group call it.
Spread shareSpread(Spread own, uint block) {
    if (kLanes == 1u) return own;
    atomicMax(sLongest[block], floatBitsToUint(own.way));
    atomicMax(sReach[block], floatBitsToUint(own.reach));
    atomicMin(sLeast[block], floatBitsToUint(own.leastPx));
    barrier();
    return Spread(
        uintBitsToFloat(sLongest[block]), uintBitsToFloat(sReach[block]),
        uintBitsToFloat(sLeast[block])
    );
}

/// Finds the lookup of each instant that the block's pixels may take. All lanes of a group call it.
/// \param isWanted false: there is no such block
Found findBlockSamples(BlockSearch search, uint block, uint lane, bool isWanted) {
    if (kLanes > 1u) {
        if (lane == 0u) {
            sIsPlane[block] = 0u;
            sLongest[block] = 0u;
            sIsMixed[block] = 0u;
            sReach[block] = 0u;
            sLeast[block] = floatBitsToUint(kFarAway);
        }
        barrier();
    }
    Spread spread = Spread(0.0f, 0.0f, kFarAway);
    if (kHasLens) {
        if (isWanted) spread = measureSpread(search, lane);
        spread = shareSpread(spread, block);
        // An edge is only smooth where it is searched; other static blocks need nothing.
        if (isWanted && hasEdges(search)) spread.reach = max(spread.reach, 2.0f * kStillReachPx);
        if (spread.reach <= kStillReachPx) isWanted = false;
    }
    uint middle = middleSet(method);
    Course course = Course(0u, vec2(0.0f), 0.0f);
    for (uint i = lane; isWanted && i < params.sampleCount; i += kLanes) {
        PlaneMap map = findBlockSample(search, i * method.setCount + middle);
        if (!map.isAffine) continue;
        if (kLanes == 1u) {
            addPlace(map.place, course);
        } else {
            sPlaces[block][i] = map.place;
            atomicOr(sIsPlane[block], 1u << i);
        }
    }
    if (kLanes > 1u) {
        barrier();
        // Each lane for itself: in the order of instants, so that the sum is the same.
        for (uint bits = sIsPlane[block]; bits != 0u; bits &= bits - 1u)
            addPlace(sPlaces[block][findLSB(bits)], course);
    }
    Found found;
    found.isUniform = course.planes == params.sampleCount;
    found.isStatic = false;
    found.leastPx = 0.0f;
    if (kHasLens) {
        chooseSets(spread, found);
        return withOwnSets(search, found, block, lane, isWanted);
    }
    if (isWanted && !found.isUniform) course.way = measureWays(search, lane);
    if (kLanes > 1u) {
        if (!found.isUniform) atomicMax(sLongest[block], floatBitsToUint(max(course.way, 0.0f)));
        barrier();
        if (!found.isUniform) course.way = uintBitsToFloat(sLongest[block]);
    }
    chooseInstants(course.way, found);
    return withOwnSets(search, found, block, lane, isWanted);
}

void listBlock(uvec2 block, uvec2 blocks, uint list) {
    uint index = list == kUniformList ? atomicAdd(uBlocks.header.uniformCount, 1u)
                                      : atomicAdd(uBlocks.header.mixedCount, 1u);
    uBlocks.entries[list * blocks.x * blocks.y + index] = block.x | block.y << 16;
    atomicMax(uArguments[list].groupsX, min(index + 1u, kListRow));
    if (index % kListRow == 0u) atomicAdd(uArguments[list].groupsY, 1u);
}

/// Blocks that need more than the usual search.
void listGeneral(uvec2 block) {
    uint index = atomicAdd(uGeneral.header.uniformCount, 1u); // kCandidateList is the first of its own
    uGeneral.entries[index] = block.x | block.y << 16;
    atomicMax(uGeneralArguments.groupsX, min(index + 1u, kListRow));
    if (index % kListRow == 0u) atomicAdd(uGeneralArguments.groupsY, 1u);
}

/// Whether several candidates of the tile, which is not crowded, belong to one entity.
bool isGeneral(uint tile) {
    if (!has(method, kHasGeneralTiles)) return false;
    uint ranges = uRaster[tile].ranges[kRangesMask];
    if (has(method, kHasLastLayer)) ranges |= uLast[tile].ranges[kRangesMask];
    if (has(method, kHasSecondLayer)) ranges |= uSecond[tile].ranges[kRangesMask];
    return ranges != 0u;
}

/// A block of a crowded tile, of which nothing is known but how far things go.
void addCrowded(uvec2 block, uint tile, uint firstSample) {
    if (block % (kCandidateTilePx / kGroupSize) == uvec2(0u))
        atomicAdd(uCounters.crowdedTiles, 1u);
    listGeneral(block);
    if (params.uniformMotionPx == 0.0f) return;
    Found found;
    chooseInstants(uintBitsToFloat(~CrowdTable(method.crowds).tiles[tile].wayInverted), found);
    if (kHasLens) found.instants = params.sampleCount;
    uBlockSamples[firstSample].perX = found.instants;
    uBlockSamples[firstSample].perY = floatBitsToUint(found.noise);
}

/// \return whether something may move in the block's tile
bool moves(uint tile) {
    if (uRaster[tile].candidates[0].key != kNoKey) return true;
    if (has(method, kHasLastLayer) && uLast[tile].candidates[0].key != kNoKey) return true;
    return has(method, kHasSecondLayer) && uSecond[tile].candidates[0].key != kNoKey;
}

void main() {
    uint inGroup = gl_LocalInvocationIndex / kLanes;
    uint lane = gl_LocalInvocationIndex % kLanes;
    uvec2 block = gl_WorkGroupID.xy * kBlocksAcross +
                  uvec2(inGroup % kBlocksAcross, inGroup / kBlocksAcross);
    uvec2 blocks = countBlocks();
    bool isThere = all(lessThan(block, blocks));
    uvec2 tiles = countTiles(params.sizePx);
    uvec2 tileAt = block * kGroupSize / kCandidateTilePx;
    uint tile = tileAt.y * tiles.x + tileAt.x;
    uint firstSample = (block.y * blocks.x + block.x) * looksPerBlock(method);
    if (isThere && isCrowded(tile)) {
        if (lane == 0u) addCrowded(block, tile, firstSample);
        isThere = false;
    }
    isThere = isThere && moves(tile);
    bool isUniform = false;
    if (params.uniformMotionPx > 0.0f) {
        InstantMotionsRef motions = InstantMotionsRef(method.motions);
        BlockSearch search = BlockSearch(
            ivec2(block), tile, firstSample + 1u, partsPerInstant(method),
            motions.value.isPerspective != 0u, getLayer(motions, kRasterLayer)
        );
        Found found = findBlockSamples(search, inGroup, lane, isThere);
        if (kHasLens && found.isStatic) isThere = false;
        if (isThere && lane == 0u) {
            if (kHasLens) uBlockSamples[firstSample].place = vec2(found.leastPx, 0.0f);
            uBlockSamples[firstSample].perX = found.instants;
            uBlockSamples[firstSample].perY = floatBitsToUint(found.noise);
        }
        isUniform = kSortsUniform && found.isUniform;
    }
    if (!isThere || lane != 0u) return;
    if (!isUniform && isGeneral(tile))
        listGeneral(block);
    else
        listBlock(block, blocks, isUniform ? kUniformList : kMixedList);
}
