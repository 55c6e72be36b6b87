// SPDX-License-Identifier: MIT
// The search for what a pixel saw at an instant: which surface of which layer. Whoever includes this
// has the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_SEARCH_GLSL
#define SHUTTER_RESOLVED_SEARCH_GLSL

#include "common/numeric.glsl"
#include "motion_blur/resolved.glsl"

layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uSurface;
layout(binding = 3) uniform sampler2D uLastColor;
layout(binding = 4) uniform sampler2D uLastSurface;
layout(binding = 5, rgba16f) uniform writeonly image2D uBlurred;
layout(binding = 6, scalar) readonly buffer RasterCandidates { TileCandidates uRasterTiles[]; };
layout(binding = 7, scalar) readonly buffer LastCandidates { TileCandidates uLastTiles[]; };
layout(binding = 8, scalar) buffer Counters { ResolvedCounters uCounters; };

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
const uint kMostSeeds = 5u;
const float kSeedDistancePx = 4.0f;

/// A surface that a pixel saw at an instant.
struct Seen {
    bool isFound;
    uint layer;
    uint key;
    vec2 at;     // in the layer's picture
    float depth; // at the instant
};

/// What a search knows besides what it found.
struct Doubt {
    // Beside the surface that hides the rest of the raster at this pixel, where that surface would be
    // if it were seen: the nearest that is known of what came into sight.
    bool hasBeside;
    ivec2 beside; // in this frame's raster
    // Edges run through the pixel, or colours are interpolated: bounds of the colours beside.
    bool hasEdge;
    vec3 leastAcross;
    vec3 greatestAcross;
};

const Doubt kNoDoubt = Doubt(false, ivec2(0), false, vec3(kMaxColor), vec3(0.0f));

vec2 fetchSurface(uint layer, ivec2 at) {
    vec2 uv = (vec2(at) + 0.5f) / vec2(params.sizePx);
    return layer == kRasterLayer ? textureLod(uSurface, uv, 0.0f).xy
                                 : textureLod(uLastSurface, uv, 0.0f).xy;
}

vec3 fetchColor(uint layer, ivec2 at) {
    vec2 uv = (vec2(at) + 0.5f) / vec2(params.sizePx);
    return layer == kRasterLayer ? textureLod(uColor, uv, 0.0f).rgb
                                 : textureLod(uLastColor, uv, 0.0f).rgb;
}

bool isInside(vec2 at) {
    return all(greaterThanEqual(at, vec2(0.0f))) && all(lessThan(at, vec2(params.sizePx)));
}

ivec2 keepInside(ivec2 texel) { return clamp(texel, ivec2(0), ivec2(params.sizePx) - 1); }

/// The four pixels around a place in the order of textureGather, and their bilinear weights.
struct Footprint {
    ivec2 corner; // the upper left one
    vec4 weights;
};

Footprint footprintOf(vec2 at) {
    vec2 corner = floor(at - 0.5f);
    vec2 share = at - 0.5f - corner;
    vec4 weights = vec4(1.0f - share.x, share.x, share.x, 1.0f - share.x) *
                   vec4(share.y, share.y, 1.0f - share.y, 1.0f - share.y);
    return Footprint(ivec2(corner), weights);
}

ivec2 texelOf(Footprint footprint, uint i) {
    return keepInside(footprint.corner + ivec2(i == 1u || i == 2u ? 1 : 0, i < 2u ? 1 : 0));
}

/// Where the four pixels meet: whatever the precision of the sampler, it gathers these.
vec2 gatherPlace(Footprint footprint) {
    return vec2(footprint.corner + 1) / vec2(params.sizePx);
}

vec4 gatherDepths(uint layer, Footprint footprint) {
    vec2 uv = gatherPlace(footprint);
    return layer == kRasterLayer ? textureGather(uSurface, uv, 0)
                                 : textureGather(uLastSurface, uv, 0);
}

/// \return whether each of the pixels is of the entity
bvec4 gatherMatches(uint layer, uint key, Footprint footprint) {
    vec2 uv = gatherPlace(footprint);
    vec4 keys = layer == kRasterLayer ? textureGather(uSurface, uv, 1)
                                      : textureGather(uLastSurface, uv, 1);
    return equal(keys, vec4(float(key)));
}

/// Bilinear among the pixels of the entity, one of which holds the place. What is linear in the
/// picture of a plane is its depth before an orthographic camera, the inverse before a perspective
/// one.
float interpolateDepth(uint layer, uint key, vec2 at, bool perspective) {
    Footprint footprint = footprintOf(at);
    vec4 weights = mix(vec4(0.0f), footprint.weights, gatherMatches(layer, key, footprint));
    vec4 depths = gatherDepths(layer, footprint);
    float sum = dot(weights, vec4(1.0f));
    return perspective ? sum / dot(weights, 1.0f / depths) : dot(weights, depths) / sum;
}

vec3 interpolateColor(Seen seen) {
    Footprint footprint = footprintOf(seen.at);
    bvec4 matches = gatherMatches(seen.layer, seen.key, footprint);
    vec3 sum = vec3(0.0f);
    float weights = 0.0f;
    for (uint i = 0u; i < 4u; ++i) {
        if (!matches[i]) continue;
        sum += footprint.weights[i] * fetchColor(seen.layer, texelOf(footprint, i));
        weights += footprint.weights[i];
    }
    return weights > 0.0f ? sum / weights : fetchColor(seen.layer, ivec2(seen.at));
}

/// A place at a pixel's centre has that pixel's bits.
vec3 colorOf(Seen seen) {
    return fract(seen.at) == vec2(0.5f) ? fetchColor(seen.layer, ivec2(seen.at))
                                        : interpolateColor(seen);
}

void keepNearer(inout Seen best, uint layer, uint key, vec2 at, float depth) {
    // Coplanar surfaces: the same one wins in whatever order they are met.
    if (best.isFound && (depth > best.depth || (depth == best.depth && key >= best.key))) return;
    best = Seen(true, layer, key, at, depth);
}

void addEdge(vec3 color, inout Doubt doubt) {
    doubt.hasEdge = true;
    doubt.leastAcross = min(doubt.leastAcross, color);
    doubt.greatestAcross = max(doubt.greatestAcross, color);
}

/// The entity is not where the search came to. Is it next to it?
void noteMiss(uint layer, uint key, vec2 at, uint hiding, inout Doubt doubt) {
    if (layer == kRasterLayer && key == hiding && !doubt.hasBeside) {
        doubt.hasBeside = true;
        doubt.beside = ivec2(at);
    }
    if (!kFindsEdges) return;
    Footprint footprint = footprintOf(at);
    bvec4 matches = gatherMatches(layer, key, footprint);
    for (uint i = 0u; i < 4u; ++i)
        if (matches[i]) addEdge(fetchColor(layer, texelOf(footprint, i)), doubt);
}

/// Another entity within the footprint of what was found, or other colours of the same one.
void noteEdge(Seen seen, vec3 color, inout Doubt doubt) {
    if (fract(seen.at) == vec2(0.5f)) return;
    Footprint footprint = footprintOf(seen.at);
    bvec4 matches = gatherMatches(seen.layer, seen.key, footprint);
    for (uint i = 0u; i < 4u; ++i) {
        vec3 beside = fetchColor(seen.layer, texelOf(footprint, i));
        addEdge(matches[i] ? mix(color, beside, kInnerShare) : beside, doubt);
    }
}

/// Looks for the place in the layer of what the pixel sees of an entity, from a guess at its depth.
/// \param spreadPx way between the places at the entity's nearest and farthest depth: how much the
/// depth matters
/// \return whether it was found
bool searchRigid(
    uint layer, uint key, InstantMotion motion, bool perspective, vec2 x, float depth,
    float spreadPx, uint hiding, inout Seen best, inout Doubt doubt
) {
    vec2 at = projectPicture(
        transformRows(motion.rasterFromInstant, pictureSpace(x, depth, perspective)), perspective
    );
    for (uint step_ = 0u; step_ < kSteps; ++step_) {
        if (!isInside(at)) return false;
        ivec2 texel = ivec2(at);
        vec2 surface = fetchSurface(layer, texel);
        if (uint(surface.y) != key) {
            noteMiss(layer, key, at, hiding, doubt);
            return false;
        }
        float layerDepth =
            spreadPx > kInterpolatedSpreadPx ? interpolateDepth(layer, key, at, perspective)
                                             : surface.x;
        float instantDepth = dot(
            motion.instantFromRaster[2],
            pictureSpace(at, depthOfKey(key, layerDepth), perspective)
        );
        if (perspective && instantDepth < kLeastDepth) return false;
        if (spreadPx < kArrivedPx) {
            keepNearer(best, layer, key, at, key == kSkyKey ? kFarthest : instantDepth);
            return true;
        }
        vec2 next = projectPicture(
            transformRows(motion.rasterFromInstant, pictureSpace(x, instantDepth, perspective)),
            perspective
        );
        float way = distance(next, at);
        at = next;
        if (way > kArrivedPx && step_ + 1u < kSteps) continue;
        if (way > kTolerancePx || !isInside(at)) return false;
        if (ivec2(at) != texel && uint(fetchSurface(layer, ivec2(at)).y) != key) {
            noteMiss(layer, key, at, hiding, doubt);
            return false;
        }
        keepNearer(best, layer, key, at, key == kSkyKey ? kFarthest : instantDepth);
        return true;
    }
    return false;
}

void searchDepths(
    uint layer, Candidate candidate, InstantMotion motion, bool perspective, vec2 x, uint hiding,
    inout Seen best, inout Doubt doubt
) {
    if (motion.rasterFromInstant[2] == vec4(0.0f)) return;
    float nearest = uintBitsToFloat(candidate.nearest);
    float farthest = uintBitsToFloat(~candidate.farthestInverted);
    vec2 from = projectPicture(
        transformRows(motion.rasterFromInstant, pictureSpace(x, nearest, perspective)), perspective
    );
    vec2 to = projectPicture(
        transformRows(motion.rasterFromInstant, pictureSpace(x, farthest, perspective)), perspective
    );
    float way = distance(from, to);
    uint seeds = way < 1.0f ? 1u : clamp(uint(way / kSeedDistancePx) + 2u, 2u, kMostSeeds);
    for (uint seed = 0u; seed < seeds; ++seed) {
        float share = seeds == 1u ? 0.5f : float(seed) / float(seeds - 1u);
        // Places along the way are evenly spaced in the inverse of the depth.
        float depth = perspective && nearest > 0.0f
                          ? 1.0f / mix(1.0f / nearest, 1.0f / farthest, share)
                          : mix(nearest, farthest, share);
        // From near to far: the first place found is, as a rule, the one that hides the others.
        if (searchRigid(
                layer, candidate.key, motion, perspective, x, depth, way, hiding, best, doubt
            ))
            return;
    }
}

/// By the motion vectors of this frame's raster, taken as straight.
/// \param time shutter time since the raster instant
void searchDeformed(
    uint key, float time, vec2 x, uint hiding, inout Seen best, inout Doubt doubt
) {
    vec2 at = x;
    for (uint step_ = 0u; step_ < kSteps; ++step_) {
        if (!isInside(at)) return;
        ivec2 texel = ivec2(at);
        vec2 surface = fetchSurface(kRasterLayer, texel);
        if (uint(surface.y) != key) {
            noteMiss(kRasterLayer, key, at, hiding, doubt);
            return;
        }
        vec2 next = x - texelFetch(uMotionDepth, texel, 0).xy * time;
        float way = distance(next, at);
        at = next;
        if (way > kArrivedPx && step_ + 1u < kSteps) continue;
        if (way > kTolerancePx || !isInside(at)) return;
        if (ivec2(at) != texel && uint(fetchSurface(kRasterLayer, ivec2(at)).y) != key) return;
        keepNearer(best, kRasterLayer, key, at, surface.x);
        return;
    }
}

/// What the searches of one pixel share.
struct PixelSearch {
    vec2 x;
    uint tile;
    uint hiding; // key of what this frame's raster has at the pixel
    LayerMotion raster;
    LayerMotion last;
    Seen still; // what stands still there, at all instants
    Seen lastStill;
};

Candidate getCandidate(uint layer, uint tile, uint slot) {
    if (layer == kLastLayer) return uLastTiles[tile].candidates[slot];
    return uRasterTiles[tile].candidates[slot];
}

/// A bit for each candidate that the tile may see in that part of the exposure.
uint getPart(uint layer, uint tile, uint part) {
    return layer == kLastLayer ? uLastTiles[tile].parts[part] : uRasterTiles[tile].parts[part];
}

void searchLayer(
    uint index, LayerMotion layer, PixelSearch pixel, uint instant, inout Seen best,
    inout Doubt doubt
) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    bool perspective = motions.value.isPerspective != 0u;
    uint slots = getPart(index, pixel.tile, partOf(instant, params.sampleCount));
    while (slots != 0u) {
        Candidate candidate = getCandidate(index, pixel.tile, uint(findLSB(slots)));
        slots &= slots - 1u;
        // The rest lies behind what was found. It counts all the same where edges do.
        if (!kFindsEdges && best.isFound &&
            (candidate.key == kSkyKey || uintBitsToFloat(candidate.nearest) > best.depth))
            break;
        uint mover = findMover(layer, candidate.key);
        if (mover == kDeformedMover)
            searchDeformed(
                candidate.key, timeOf(motions, instant) - params.rasterTime, pixel.x, pixel.hiding,
                best, doubt
            );
        else
            searchDepths(
                index, candidate,
                InstantMotionTable(layer.motions).motions[mover * params.sampleCount + instant],
                perspective, pixel.x, pixel.hiding, best, doubt
            );
    }
}

/// What stands still at the pixel itself in the layer.
Seen findStill(uint index, LayerMotion layer, ivec2 pixel) {
    vec2 surface = fetchSurface(index, pixel);
    uint key = uint(surface.y);
    return Seen(
        isStillMover(layer, findMover(layer, key)), index, key, vec2(pixel) + 0.5f, surface.x
    );
}

PixelSearch beginSearch(ivec2 pixel) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    uvec2 tiles = (params.sizePx + kCandidateTilePx - 1u) / kCandidateTilePx;
    uvec2 tile = uvec2(pixel) / kCandidateTilePx;
    PixelSearch search;
    search.x = vec2(pixel) + 0.5f;
    search.tile = tile.y * tiles.x + tile.x;
    search.raster = getLayer(motions, kRasterLayer);
    search.last = getLayer(motions, kLastLayer);
    search.still = findStill(kRasterLayer, search.raster, pixel);
    search.hiding = search.still.key;
    search.lastStill = Seen(false, kLastLayer, kNoKey, search.x, 0.0f);
    if (method.hasLast != 0u && !search.still.isFound)
        search.lastStill = findStill(kLastLayer, search.last, pixel);
    return search;
}

Seen searchInstant(PixelSearch pixel, uint instant, inout Doubt doubt) {
    Seen seen = pixel.still;
    searchLayer(kRasterLayer, pixel.raster, pixel, instant, seen, doubt);
    if (!seen.isFound && method.hasLast != 0u) {
        seen = pixel.lastStill;
        searchLayer(kLastLayer, pixel.last, pixel, instant, seen, doubt);
    }
    return seen;
}

/// How much harm it may do not to trace the sample.
uint classify(Seen seen, vec3 color, Doubt doubt) {
    if (!seen.isFound) return kUnresolvedClass;
    noteEdge(seen, color, doubt);
    if (!doubt.hasEdge) return kOtherClass;
    vec3 gap = max(abs(doubt.leastAcross - color), abs(doubt.greatestAcross - color));
    float harm = min(max(gap.x, max(gap.y, gap.z)), 1.0f);
    uint halvings = uint(max(-log2(max(harm, 1.0e-6f)), 0.0f));
    uint edgeClass = kFirstEdgeClass + halvings;
    return edgeClass <= kLastEdgeClass ? edgeClass : kOtherClass;
}

#endif
