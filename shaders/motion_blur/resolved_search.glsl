// SPDX-License-Identifier: MIT
// Searches the sample of a pixel at an instant: which surface of which layer. The including shader
// has the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_SEARCH_GLSL
#define SHUTTER_RESOLVED_SEARCH_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "common/numeric.glsl"
#include "motion_blur/pixel_ray.glsl"
#include "motion_blur/resolved_layers.glsl"
#include "motion_blur/resolved_lens.glsl"

/// Fixed-point steps of a search.
const uint kSteps = 4u;
/// Farthest that the surface found may be from the pixel's centre, pixels.
const float kTolerancePx = 1.0f;
/// Within which a step has arrived.
const float kArrivedPx = 0.125f;
/// Spread of an entity's places by depth from which its depth is interpolated between pixels.
const float kInterpolatedSpreadPx = 0.5f;
/// How much less harm than a border between entities a border within one does, where colours are
/// interpolated.
const float kInnerShare = 0.25f;
/// Depth of the sky: behind everything.
const float kFarthest = 3.0e38f;
/// Places that the way between the nearest and the farthest depth is searched from, at most.
const uint kMaxSeeds = 5u;
const float kSeedDistancePx = 4.0f;
/// Ways shorter than this are searched from their middle alone.
const float kSeedlessWayPx = 2.0f;

/// Uncertainty of a search result.
struct Doubt {
    // Edges run through the pixel, or colours are interpolated: bounds of the neighbouring colours.
    bool hasEdge;
    vec3 leastAcross;
    vec3 greatestAcross;
};

const Doubt kNoDoubt = Doubt(false, vec3(kMaxColor), vec3(0.0f));

/// Depth that surfaces are compared by.
float behindSky(uint key, float depth) { return key == kSkyKey ? kFarthest : depth; }

/// \param x the pixel that sees them
bool isNearer(Seen a, Seen b, vec2 x) {
    if (a.depth != b.depth) return a.depth < b.depth;
    // Coplanar: a mover is drawn over a static surface. Only places are compared, so that entity
    // rows make no difference.
    float wayA = distance(a.at, x);
    float wayB = distance(b.at, x);
    if (wayA != wayB) return wayA > wayB;
    return a.at.y != b.at.y ? a.at.y < b.at.y : a.at.x < b.at.x;
}

void keepNearer(inout Seen best, Seen other, vec2 x) {
    if (!best.isFound || isNearer(other, best, x)) best = other;
}

void addEdge(vec3 color, inout Doubt doubt) {
    doubt.hasEdge = true;
    doubt.leastAcross = min(doubt.leastAcross, color);
    doubt.greatestAcross = max(doubt.greatestAcross, color);
}

/// The entity is not where the search ended; records its place if that is adjacent.
void noteMiss(uint layer, uint key, uint range, vec2 at, inout Doubt doubt) {
    if (!kFindsEdges) return;
    Footprint footprint = footprintOf(at);
    bvec4 matches = gatherMatches(layer, key, range, footprint);
    for (uint i = 0u; i < 4u; ++i)
        if (matches[i]) addEdge(fetchColor(layer, texelOf(footprint, i)), doubt);
}

/// Records another entity within the footprint of the sample, or other colours of the same one.
void noteEdge(Seen seen, vec3 color, inout Doubt doubt) {
    if (fract(seen.at) == vec2(0.5f)) return;
    Footprint footprint = footprintOf(seen.at);
    uint key = seen.key;
    if (key == kNoKey) key = fetchSurface(seen.layer, ivec2(seen.at)).key;
    bvec4 matches = gatherMatches(seen.layer, key, seen.range, footprint);
    for (uint i = 0u; i < 4u; ++i) {
        vec3 neighbour = fetchColor(seen.layer, texelOf(footprint, i));
        addEdge(matches[i] ? mix(color, neighbour, kInnerShare) : neighbour, doubt);
    }
}

/// Where on a pixel's ray a candidate was found last: the next instant's first guess.
struct Guess {
    uint id; // idOf()
    float along;
};

/// Identifies a candidate within its tile: the key, and the slot where an entity has several candidates.
uint idOf(uint key, uint range, uint slot) { return range == kAnyRange ? key : key | (slot + 1u) << kKeyBitCount; }

struct Guesses {
    Guess raster;
    Guess second;
    Guess last;
};

/// Whether other layers are searched for what a lens sees beyond the border. The passes of `adaptive`, which
/// search in general, have no register left for that on GPUs (tests/gpu_static); rays go there first.
bool searchesBeyond() { return kHasLens && !(kFindsEdges && kIsGeneral); }

/// Whether withinBorder() moves a place.
bool isBeyondBorder(uint layer, vec2 at) {
    return searchesBeyond() && layer == kRasterLayer && !isInside(at);
}

/// Marks a place on the border as one beyond it, which withinBorder() takes back.
vec2 beyondBorder(vec2 at) {
    return at - vec2(lessThanEqual(at, vec2(0.5f))) +
           vec2(greaterThanEqual(at, vec2(params.sizePx) - 0.5f));
}

/// Searches the pixel's sample on a candidate, from one place on the ray.
/// \param begin where on the ray; where it was found
/// \param spreadPx way between the places at the entity's nearest and farthest depth: how much the
/// depth matters
/// \return whether it was found
bool searchRigid(
    uint layer, uint key, uint range, vec4 instantDepthRow, PixelRay ray, bool perspective,
    inout float begin, float spreadPx, inout Seen found, inout Doubt doubt
) {
    vec2 place = placeOn(ray, begin, perspective);
    bool isBeyond = isBeyondBorder(layer, place);
    vec2 at = withinBorder(layer, place);
    for (uint step_ = 0u; step_ < kSteps; ++step_) {
        if (!isInside(at)) return false;
        ivec2 texel = ivec2(at);
        Probe surface = fetchSurfaceAt(layer, at);
        if (!isOf(surface, key, range)) {
            noteMiss(layer, key, range, at, doubt);
            return false;
        }
        float layerDepth =
            spreadPx > kInterpolatedSpreadPx
                ? interpolateDepth(layer, key, range, at, surface.depth, perspective)
                : surface.depth;
        float depth =
            dot(instantDepthRow, pictureSpace(at, depthOfKey(key, layerDepth), perspective));
        if (perspective && depth < kMinDepth) return false;
        float along = alongOf(depth, perspective);
        if (spreadPx >= kArrivedPx) {
            place = placeOn(ray, along, perspective);
            isBeyond = isBeyondBorder(layer, place);
            vec2 next = withinBorder(layer, place);
            float way = distance(next, at);
            at = next;
            if (way > kArrivedPx && step_ + 1u < kSteps) continue;
            if (way > kTolerancePx || !isInside(at)) return false;
            if ((kHasEdges || ivec2(at) != texel) &&
                !isOf(fetchSurfaceAt(layer, at), key, range)) {
                noteMiss(layer, key, range, at, doubt);
                return false;
            }
        }
        begin = along;
        if (isBeyond) at = beyondBorder(at);
        found = Seen(true, layer, key, at, behindSky(key, depth), false, range);
        return true;
    }
    return false;
}

const uint kFound = 0u;   // the search is over
const uint kMissed = 1u;  // the entity is not at the first place
const uint kUnclear = 2u; // it is there, but the sample needs a full search

/// Accepts the first guess where it is right and no other entity is near, as for most samples.
/// \return kFound, kMissed or kUnclear
uint searchInner(
    uint layer, uint key, uint range, vec4 instantDepthRow, PixelRay ray, bool perspective,
    inout float guess, float spreadPx, inout Seen found, inout Doubt doubt
) {
    vec2 place = placeOn(ray, guess, perspective);
    bool isBeyond = isBeyondBorder(layer, place);
    vec2 at = withinBorder(layer, place);
    if (!isInside(at)) return kMissed;
    vec2 texel = floor(at);
    Probe surface = fetchSurfaceAt(layer, at);
    if (!isOf(surface, key, range)) {
        noteMiss(layer, key, range, at, doubt);
        return kMissed;
    }
    float layerDepth = depthOfKey(key, surface.depth);
    float depth = dot(instantDepthRow, pictureSpace(at, layerDepth, perspective));
    float along = alongOf(depth, perspective);
    place = at;
    if (spreadPx >= kArrivedPx) {
        place = placeOn(ray, along, perspective);
        isBeyond = isBeyondBorder(layer, place);
        place = withinBorder(layer, place);
    }
    if (!isInner(surface.innerCorners, place - texel)) return kUnclear;
    if (distance(place, at) > kArrivedPx || !isInside(place)) return kUnclear;
    if (perspective && depth < kMinDepth) return kUnclear;
    guess = along;
    if (isBeyond) place = beyondBorder(place);
    found = Seen(true, layer, key, place, behindSky(key, depth), true, range);
    return kFound;
}

/// A place on a pixel's ray between the depths that its tile sees of an entity.
/// \param share 0: nearest, 1: farthest
float alongAt(Candidate candidate, float share, bool perspective) {
    float nearest = uintBitsToFloat(candidate.nearest);
    float farthest = uintBitsToFloat(~candidate.farthestInverted);
    // What reaches the camera's own plane has no inverse of its depth there.
    if (nearest <= 0.0f) return alongOf(mix(nearest, farthest, share), perspective);
    return mix(alongOf(nearest, perspective), alongOf(farthest, perspective), share);
}

/// Searches the place in the layer of the pixel's sample on an entity. With a lens, the place may be beyond
/// the border of this frame's raster (isContinued()).
/// \param id idOf()
/// \param guess where it was found at the instant before, if it was this candidate; where it is now
void searchDepths(
    uint layer, Candidate candidate, uint range, uint id, InstantMotion motion, bool perspective, vec2 x,
    inout Guess guess, inout Seen found, inout Doubt doubt
) {
    if (motion.rasterFromInstant[2] == vec4(0.0f)) return;
    PixelRay ray = findRay(motion.rasterFromInstant, x, perspective);
    float way = distance(
        placeOn(ray, alongAt(candidate, 0.0f, perspective), perspective),
        placeOn(ray, alongAt(candidate, 1.0f, perspective), perspective)
    );
    vec4 depthRow = motion.instantFromRaster[2];
    bool hasGuess = guess.id == id;
    float tried = hasGuess ? guess.along : alongAt(candidate, 0.5f, perspective);
    uint first = searchInner(
        layer, candidate.key, range, depthRow, ray, perspective, tried, way, found, doubt
    );
    if (first == kFound) {
        guess = Guess(id, tried);
        return;
    }
    bool triesGuess = first == kUnclear && (hasGuess || way < kSeedlessWayPx);
    uint seeds = 0u;
    if (way >= kSeedlessWayPx)
        seeds = max(uint(min(way / kSeedDistancePx + 2.0f, float(kMaxSeeds))), 2u);
    // One loop over the guess and the seeds, since compilers write out every call. From near to far: the
    // first place found is, as a rule, the one that hides the others.
    [[dont_unroll]] for (uint i = triesGuess ? 0u : 1u; i <= seeds; ++i) {
        if (i > 0u)
            tried = alongAt(candidate, float(i - 1u) / float(seeds - 1u), perspective);
        if (searchRigid(
                layer, candidate.key, range, depthRow, ray, perspective, tried, way, found, doubt
            )) {
            guess = Guess(id, tried);
            return;
        }
    }
}

#include "motion_blur/resolved_part_search.glsl"

/// Data shared by the searches of one pixel.
struct PixelSearch {
    vec2 x;        // the place that is searched from
    vec2 centre;   // of the pixel
    bool isAtEdge; // an edge was near at the previous instant: the next one uses an individual
                   // place
    uint tile;
    bool perspective;
    uint firstSample;  // index of the first BlockSample of its block
    uint set;    // of instants
    bool hasOwnSet; // pixels of its block take turns in all sets
    vec2 inBlock; // from the block's centre
    bool isCrowded; // its tile is crowded: candidates are not listed
    uint partsPerInstant; // found once: software devices divide integers one by one
    LayerMotion raster;
    LayerMotion second;
    LayerMotion last;
    // A bit for each candidate of the tile that has a range of depths, by layer.
    uint rasterRanges;
    uint secondRanges;
    uint lastRanges;
    Seen still; // the static surface there, at all instants
    Seen secondStill;
    Seen lastStill;
};

/// Depths in the layer that belong to the tile's candidate. Few have a range: the load is spared.
uint getRange(PixelSearch pixel, uint layer, uint slot) {
    if (!kIsGeneral) return kAnyRange;
    uint ranges = layer == kLastLayer ? pixel.lastRanges : pixel.rasterRanges;
    if (isSecond(layer)) ranges = pixel.secondRanges;
    return (ranges >> slot & 1u) != 0u ? readRange(layer, pixel.tile, slot) : kAnyRange;
}

/// How much farther, as a share, a surface must be to refute a nearer one.
const float kRefutingShare = 1.0e-3f;

/// How far from the pixel a surface of the same entity is seen, at least, that is not the one sought.
const float kOtherSurfacePx = 1.5f;

/// Distance of a place from its pixel's sample position.
float fromCentre(vec2 at) { return distance(fract(at), vec2(0.5f)); }

/// Whether this frame's raster shows something farther where it would show the surface: then the pixel
/// did not see it. Without this, a mover would be as wide as the widest of its rasters has it, by up to
/// half a pixel at each edge.
/// \param found in another layer
bool isRefuted(PixelSearch pixel, uint instant, Seen found) {
    if (found.key == kSkyKey) return false;
    InstantMotions motions = InstantMotionsRef(method.motions).value;
    uint row = RowTable(isSecond(found.layer) ? motions.secondRows : motions.lastRows)
                   .rows[found.key];
    uint mover = findMover(pixel.raster, row);
    if (mover == kNoMover || isDeformed(mover)) return false;
    InstantMotion motion = motionAt(method, kHasLens, pixel.raster, mover, instant);
    if (motion.rasterFromInstant[2] == vec4(0.0f)) return false;
    vec3 inRaster = transformRows(
        motion.rasterFromInstant, pictureSpace(pixel.x, found.depth, pixel.perspective)
    );
    if (pixel.perspective && inRaster.z < kMinDepth) return false;
    vec2 at = projectPicture(inRaster, pixel.perspective);
    if (!isInside(at)) return false;
    if (fromCentre(at) > fromCentre(found.at)) return false;
    Probe surface = fetchSurfaceAt(kRasterLayer, at);
    bool isFarther =
        behindSky(surface.key, surface.depth) > inRaster.z * (1.0f + kRefutingShare);
    if (!isFarther || surface.key != row) return isFarther;
    // Another surface of the entity is one that is seen elsewhere.
    if (!kIsGeneral || (pixel.rasterRanges | pixel.secondRanges | pixel.lastRanges) == 0u) return false;
    vec3 seen = transformRows(
        motion.instantFromRaster, pictureSpace(at, surface.depth, pixel.perspective)
    );
    return distance(projectPicture(seen, pixel.perspective), pixel.x) > kOtherSurfacePx;
}

#include "motion_blur/resolved_crowd_search.glsl"

/// \param slots a bit for each candidate of the tile to search
void searchLayer(
    uint index, LayerMotion layer, PixelSearch pixel, uint instant, uint slots, inout Guess guess,
    inout Seen best, inout Doubt doubt
) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    slots &= getPart(index, pixel.tile, partOf(instant, pixel.partsPerInstant));
    while (slots != 0u) {
        uint slot = uint(findLSB(slots));
        Candidate candidate = getCandidate(index, pixel.tile, slot);
        uint range = getRange(pixel, index, slot);
        slots &= slots - 1u;
        // The remaining candidates lie behind the sample. They are still needed for edges.
        bool isBehind = best.isFound && (candidate.key == kSkyKey ||
                                         uintBitsToFloat(candidate.nearest) > best.depth);
        if (!kFindsEdges && isBehind) break;
        Seen found = Seen(false, index, kNoKey, pixel.x, 0.0f, false, kAnyRange);
        Guess tried = guess;
        if (isDeformed(candidate.mover))
            searchPart(
                index, candidate, timeOf(motions, instant),
                kHasLens ? lensOf(motions, instant) : vec4(0.0f), pixel.x, found, doubt
            );
        else
            searchDepths(
                index, candidate, range, idOf(candidate.key, range, slot),
                motionAt(method, kHasLens, layer, candidate.mover, instant), pixel.perspective,
                pixel.x, tried, found, doubt
            );
        if (isBehind) continue;
        guess = tried;
        if (!found.isFound) continue;
        if (index != kRasterLayer && isRefuted(pixel, instant, found)) continue;
        keepNearer(best, found, pixel.x);
    }
}

/// The static surface at the pixel itself in the layer.
Seen findStill(uint index, LayerMotion layer, ivec2 pixel) {
    Probe surface = fetchSurface(index, pixel);
    return Seen(
        isStillMover(layer, findMover(layer, surface.key)), index, surface.key, vec2(pixel) + 0.5f,
        surface.depth, false, kAnyRange
    );
}

PixelSearch beginSearch(ivec2 pixel) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    uvec2 tiles = countTiles(params.sizePx);
    uvec2 tile = uvec2(pixel) / kCandidateTilePx;
    PixelSearch search;
    search.centre = vec2(pixel) + 0.5f;
    search.x = search.centre;
    search.isAtEdge =
        kHasEdges && innerCornersOf(readSurface(kRasterLayer, pixel)) != kAllCorners;
    search.tile = tile.y * tiles.x + tile.x;
    uvec2 block = uvec2(pixel) / kGroupSize;
    uint blocksAcross = (params.sizePx.x + kGroupSize - 1u) / kGroupSize;
    search.firstSample = (block.y * blocksAcross + block.x) * looksPerBlock(method) + 1u;
    search.inBlock = search.x - vec2(block * kGroupSize) - 0.5f * float(kGroupSize);
    float noise = 1.0f;
    if (params.uniformMotionPx > 0.0f) noise = uintBitsToFloat(uBlockSamples[search.firstSample - 1u].perY);
    search.set = findSet(method, pixel, noise);
    search.hasOwnSet = noise > 0.0f;
    search.isCrowded = kHasCrowds && isCrowded(search.tile);
    search.perspective = motions.value.isPerspective != 0u;
    search.partsPerInstant = partsPerInstant(method);
    search.raster = getLayer(motions, kRasterLayer);
    search.second = getLayer(motions, kSecondLayer);
    search.last = getLayer(motions, kLastLayer);
    search.rasterRanges = 0u;
    search.secondRanges = 0u;
    search.lastRanges = 0u;
    if (kIsGeneral) {
        search.rasterRanges = readRange(kRasterLayer, search.tile, kRangesMask);
        if (kHasSecond) search.secondRanges = readRange(kSecondLayer, search.tile, kRangesMask);
        if (has(method, kHasLastLayer))
            search.lastRanges = readRange(kLastLayer, search.tile, kRangesMask);
    }
    search.still = findStill(kRasterLayer, search.raster, pixel);
    search.secondStill = Seen(false, kSecondLayer, kNoKey, search.x, 0.0f, false, kAnyRange);
    if (kHasSecond && !search.still.isFound)
        search.secondStill = findStill(kSecondLayer, search.second, pixel);
    search.lastStill = Seen(false, kLastLayer, kNoKey, search.x, 0.0f, false, kAnyRange);
    if (has(method, kHasLastLayer) && !search.still.isFound)
        search.lastStill = findStill(kLastLayer, search.last, pixel);
    return search;
}

/// Where in the pixel a sample of it is that has an edge near: spread evenly, also among those close in
/// time (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"). Places of samples as
/// far from the first as from the last lie opposite each other, so that the mean is the centre.
vec2 placeInPixel(PixelSearch pixel, uint index) {
    float fromMiddle = float(index) - 0.5f * float(params.sampleCount - 1u);
    return pixel.centre + fract(0.5f + fromMiddle * vec2(0.7548776662f, 0.5698402910f)) - 0.5f;
}

/// State before the first instant.
Guesses beginGuesses(PixelSearch pixel) {
    return Guesses(
        Guess(pixel.still.key, alongOf(depthOfKey(pixel.still.key, pixel.still.depth), pixel.perspective)),
        Guess(kNoKey, 0.0f), Guess(kNoKey, 0.0f)
    );
}

/// Whether a place may be the picture's border in place of what a lens sees beyond it (withinBorder()).
bool isAtBorder(vec2 at) {
    return any(lessThanEqual(at, vec2(0.5f))) || any(greaterThanEqual(at, vec2(params.sizePx) - 0.5f));
}

/// Whether this frame's raster shows its border in place of what a lens sees beyond it. Another layer may
/// show that, as the camera moves: the border counts if none does.
bool isContinued(Seen found) { return searchesBeyond() && found.isFound && !isInside(found.at); }

/// The searches of all layers as one loop, for shaders that contain much else: compilers inline every call of
/// searchLayer(), and their time grows faster than the code.
/// \param slots a bit for each candidate of this frame's raster to search
Seen searchInTurn(
    PixelSearch pixel, uint instant, uint slots, inout Guesses guesses, inout Doubt doubt
) {
    Seen seen = pixel.still;
    LayerMotion motion = pixel.raster;
    Guess guess = guesses.raster;
    uint layer = kRasterLayer;
    bool isBorder = false;    // this frame's raster has only its border for the sample
    bool takesBorder = false; // it is searched again: no other layer has the sample
    [[dont_unroll]] while (true) {
        searchLayer(layer, motion, pixel, instant, slots, guess, seen, doubt);
        if (layer == kRasterLayer) guesses.raster = guess;
        if (kHasSecond && layer == kSecondLayer) guesses.second = guess;
        if (layer == kLastLayer) guesses.last = guess;
        bool isLast = layer == kLastLayer || !has(method, kHasLastLayer);
        if (kHasSecond && layer == kRasterLayer) isLast = false;
        bool isContinuation = layer == kRasterLayer && isContinued(seen);
        if (isContinuation) seen.at = withinBorder(layer, seen.at);
        if (isContinuation && !isLast && !takesBorder) isBorder = true;
        else if (seen.isFound || takesBorder) return seen;
        if (isLast && !isBorder) return seen;
        slots = ~0u;
        if (isLast) {
            takesBorder = true;
            layer = kRasterLayer;
            motion = pixel.raster;
            guess = guesses.raster;
            seen = pixel.still;
        } else if (kHasSecond && layer == kRasterLayer) {
            layer = kSecondLayer;
            motion = pixel.second;
            guess = guesses.second;
            seen = pixel.secondStill;
        } else {
            layer = kLastLayer;
            motion = pixel.last;
            guess = guesses.last;
            seen = pixel.lastStill;
        }
    }
}

/// \param instant of the tables
Seen searchPlace(PixelSearch pixel, uint instant, inout Guesses guesses, inout Doubt doubt) {
    if (kHasCrowds && pixel.isCrowded) return searchCrowds(pixel, instant);
    uint slots = ~0u;
    if (params.uniformMotionPx > 0.0f) {
        uint sample_ = instant / kLensSets; // with a lens
        uint index = pixel.firstSample + (kHasLens ? 2u * sample_ : instant);
        BlockSample blockSample = uBlockSamples[index];
        if (blockSample.perX != kSearchedBlock) {
            vec2 at = samplePlace(blockSample, pixel.inBlock);
            if (kHasLens && pixel.set != kMiddleLensSet)
                at += stepOfSet(
                    InstantMotionsRef(method.motions), blockSample, uBlockSamples[index + 1u],
                    sample_, pixel.set, pixel.inBlock
                ).step_;
            return Seen(true, kRasterLayer, kNoKey, at, 0.0f, true, kAnyRange);
        }
        slots = blockSample.perY;
    }
    if (kFindsEdges) return searchInTurn(pixel, instant, slots, guesses, doubt);
    Seen seen = pixel.still;
    searchLayer(kRasterLayer, pixel.raster, pixel, instant, slots, guesses.raster, seen, doubt);
    bool isBorder = isContinued(seen);
    if (isBorder) seen.at = withinBorder(kRasterLayer, seen.at);
    Seen border = seen;
    if (isBorder) seen.isFound = false;
    if (kHasSecond && !seen.isFound) {
        seen = pixel.secondStill;
        searchLayer(
            kSecondLayer, pixel.second, pixel, instant, ~0u, guesses.second, seen, doubt
        );
    }
    if (!seen.isFound && has(method, kHasLastLayer)) {
        seen = pixel.lastStill;
        searchLayer(kLastLayer, pixel.last, pixel, instant, ~0u, guesses.last, seen, doubt);
    }
    if (isBorder && !seen.isFound) return border;
    return seen;
}

/// \param index of the sample among the pixel's
/// \param instant of the tables
Seen searchInstant(
    inout PixelSearch pixel, uint index, uint instant, inout Guesses guesses, inout Doubt doubt
) {
    if (kHasEdges) pixel.x = pixel.isAtEdge ? placeInPixel(pixel, index) : pixel.centre;
    Seen seen = searchPlace(pixel, instant, guesses, doubt);
    pixel.isAtEdge = !(seen.isFound && seen.isInner);
    return seen;
}

/// How much harm it may do not to trace the sample.
uint classify(Seen seen, vec3 color, Doubt doubt) {
    if (!seen.isFound || (kHasLens && isAtBorder(seen.at))) return kUnresolvedClass;
    noteEdge(seen, color, doubt);
    if (!doubt.hasEdge) return kOtherClass;
    vec3 gap = max(abs(doubt.leastAcross - color), abs(doubt.greatestAcross - color));
    float harm = min(max(gap.x, max(gap.y, gap.z)), 1.0f);
    uint halvings = uint(max(-log2(max(harm, 1.0e-6f)), 0.0f));
    uint edgeClass = kFirstEdgeClass + halvings;
    return edgeClass <= kLastEdgeClass ? edgeClass : kOtherClass;
}

#endif
