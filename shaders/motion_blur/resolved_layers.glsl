// SPDX-License-Identifier: MIT
// Layers of `resolved`: surfaces, colours, and the candidates of each tile. The including shader
// has the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_LAYERS_GLSL
#define SHUTTER_RESOLVED_LAYERS_GLSL

#include "motion_blur/resolved.glsl"
#include "motion_blur/resolved_parts.glsl"
#include "render/split_samples_shared.h"

/// TileCandidates with each candidate as one vector, which is one load.
struct ReadTile {
    uvec4 candidates[kCandidatesPerTile];
    uint parts[kExposureParts];
    uint ranges[kRangeWords];
};

layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform usampler2D uSurface;
layout(binding = 3) uniform sampler2D uLastColor;
layout(binding = 4) uniform usampler2D uLastSurface;
layout(binding = 5, rgba16f) uniform writeonly image2D uBlurred;
layout(binding = 6, scalar) readonly buffer RasterCandidates { ReadTile uRasterTiles[]; };
layout(binding = 7, scalar) readonly buffer LastCandidates { ReadTile uLastTiles[]; };
layout(binding = 8, scalar) buffer Counters { ResolvedCounters uCounters; };
layout(binding = 9) uniform sampler2D uColorLinear;
layout(binding = 10) uniform sampler2D uLastColorLinear;
layout(binding = 11, scalar) readonly buffer BlockSampleBuffer { BlockSample uBlockSamples[]; };
layout(binding = 12) uniform sampler2D uSecondColor;
layout(binding = 13) uniform usampler2D uSecondSurface;
layout(binding = 14, scalar) readonly buffer SecondCandidates { ReadTile uSecondTiles[]; };
layout(binding = 15) uniform sampler2D uSecondColorLinear;
layout(binding = 16, scalar) readonly buffer RasterParts { TilePart uRasterParts[]; };
layout(binding = 17, scalar) readonly buffer LastParts { TilePart uLastParts[]; };
layout(binding = 18, scalar) readonly buffer SecondParts { TilePart uSecondParts[]; };
// Motion of deforming entities (common/pixel_way.glsl); with kHasWays.
layout(binding = 19) uniform usampler2D uWays;
layout(binding = 20) uniform usampler2D uLastWays;
layout(binding = 21) uniform usampler2D uSecondWays;
layout(binding = 22) uniform usampler2D uEdgeSurface; // of this frame's raster; with kHasEdges

/// Whether the raster of the exposure's other end is a layer.
layout(constant_id = 2) const bool kHasSecond = false;

/// Whether several candidates of a tile may belong to one entity, distinguished by depth.
layout(constant_id = 3) const bool kIsGeneral = false;
/// Whether tiles may be crowded; implies kIsGeneral.
layout(constant_id = 7) const bool kHasCrowds = false;

/// Whether something deforms in any of the layers.
layout(constant_id = 4) const bool kHasParts = true;

/// Whether pixels of this frame's raster may show two surfaces.
layout(constant_id = 5) const bool kHasEdges = false;

/// Whether each instant has a place of the lens.
layout(constant_id = 6) const bool kHasLens = false;

bool isDeformed(uint mover) { return kHasParts && mover == kDeformedMover; }

bool isSecond(uint layer) { return kHasSecond && layer == kSecondLayer; }

/// A surface that a pixel saw at an instant.
struct Seen {
    bool isFound;
    uint layer;
    uint key;     // kNoKey: of a plane that may belong to several entities
    vec2 at;      // in the layer's picture
    float depth;  // at the instant
    bool isInner; // all that the layer shows around the place is of the same entity or plane
    uint range;   // of depths in the layer that the surface has (TileCandidates::ranges)
};

/// The surface of a layer's pixel.
struct Probe {
    uint key;
    float depth;
    uint innerCorners; // a bit for each corner of the pixel, see isInner()
};

bool isOf(Probe surface, uint key, uint range) {
    return surface.key == key && isWithin(surface.depth, range);
}

vec2 uvOf(vec2 at) { return at * (1.0f / vec2(params.sizePx)); }

uvec2 readSurface(uint layer, ivec2 at) {
    vec2 uv = uvOf(vec2(at) + 0.5f);
    uvec2 read = layer == kRasterLayer ? textureLod(uSurface, uv, 0.0f).xy
                                       : textureLod(uLastSurface, uv, 0.0f).xy;
    return isSecond(layer) ? textureLod(uSecondSurface, uv, 0.0f).xy : read;
}

Probe probeOf(uvec2 read) {
    return Probe(keyOf(read), uintBitsToFloat(read.x), innerCornersOf(read));
}

/// The pixel's own surface.
Probe fetchSurface(uint layer, ivec2 at) { return probeOf(readSurface(layer, at)); }

/// Whether another surface than the pixel's own is nearest to the place. The pixel's centre is its own.
bool isOfOther(uint layer, vec2 at, uvec2 read) {
    if (!kHasEdges || layer != kRasterLayer || otherSamplesOf(read) == 0u) return false;
    vec2 from = fract(at);
    return from != vec2(0.5f) && (otherSamplesOf(read) >> nearestSample(from) & 1u) != 0u;
}

/// The other surface of a pixel of this frame's raster.
Probe fetchOther(ivec2 at) {
    uvec2 other = textureLod(uEdgeSurface, uvOf(vec2(at) + 0.5f), 0.0f).xy;
    return Probe(keyOfId(other.y), max(uintBitsToFloat(other.x), 0.0f), 0u);
}

vec3 fetchOtherColor(ivec2 at) {
    uvec2 color = textureLod(uEdgeSurface, uvOf(vec2(at) + 0.5f), 0.0f).zw;
    return vec3(unpackHalf2x16(color.x), unpackHalf2x16(color.y).x);
}

/// The surface at a place between the centres of pixels.
Probe fetchSurfaceAt(uint layer, vec2 at) {
    uvec2 read = readSurface(layer, ivec2(at));
    return isOfOther(layer, at, read) ? fetchOther(ivec2(at)) : probeOf(read);
}

vec3 fetchColor(uint layer, ivec2 at) {
    vec2 uv = uvOf(vec2(at) + 0.5f);
    if (isSecond(layer)) return textureLod(uSecondColor, uv, 0.0f).rgb;
    return layer == kRasterLayer ? textureLod(uColor, uv, 0.0f).rgb
                                 : textureLod(uLastColor, uv, 0.0f).rgb;
}

bool isInside(vec2 at) {
    return all(greaterThanEqual(at, vec2(0.0f))) && all(lessThan(at, vec2(params.sizePx)));
}

/// With a lens the picture is extended by its border pixels: they are the best estimate of blur
/// from beyond the border.
vec2 withinBorder(uint layer, vec2 at) {
    if (!kHasLens || layer != kRasterLayer) return at;
    return clamp(at, vec2(0.5f), vec2(params.sizePx) - 0.5f);
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
    return uvOf(vec2(footprint.corner + 1));
}

vec4 gatherDepths(uint layer, Footprint footprint) {
    vec2 uv = gatherPlace(footprint);
    if (isSecond(layer)) return uintBitsToFloat(textureGather(uSecondSurface, uv, 0));
    return uintBitsToFloat(
        layer == kRasterLayer ? textureGather(uSurface, uv, 0) : textureGather(uLastSurface, uv, 0)
    );
}

/// \return whether each of the pixels is of the entity and within the range
bvec4 gatherMatches(uint layer, uint key, uint range, Footprint footprint) {
    vec2 uv = gatherPlace(footprint);
    uvec4 keys = layer == kRasterLayer ? textureGather(uSurface, uv, 1)
                                       : textureGather(uLastSurface, uv, 1);
    if (isSecond(layer)) keys = textureGather(uSecondSurface, uv, 1);
    bvec4 isSame = equal(keys & kKeyBits, uvec4(key));
    if (range == kAnyRange) return isSame;
    uvec4 depths = floatBitsToUint(gatherDepths(layer, footprint)) >> 16u;
    bvec4 isInRange = lessThanEqual(depths - (range & 0xFFFFu), uvec4(range >> 16u));
    return bvec4(uvec4(isSame) & uvec4(isInRange));
}

/// Bilinear among the pixels of the entity. Across a plane in the picture, depth is linear for an
/// orthographic camera, and inverse depth for a perspective one.
/// \param nearest depth at the place's pixel, which may be of another surface
float interpolateDepth(uint layer, uint key, uint range, vec2 at, float nearest, bool perspective) {
    Footprint footprint = footprintOf(at);
    vec4 weights = mix(vec4(0.0f), footprint.weights, gatherMatches(layer, key, range, footprint));
    // A depth of weight 0 may itself be 0, and 0 / 0 is NaN.
    vec4 depths = mix(vec4(1.0f), gatherDepths(layer, footprint), greaterThan(weights, vec4(0.0f)));
    float sum = dot(weights, vec4(1.0f));
    if (kHasEdges && sum == 0.0f) return nearest;
    return perspective ? sum / dot(weights, 1.0f / depths) : dot(weights, depths) / sum;
}

/// One channel of the four pixels' colours.
vec4 gatherChannel(uint layer, vec2 uv, int channel) {
    if (isSecond(layer)) {
        if (channel == 0) return textureGather(uSecondColor, uv, 0);
        if (channel == 1) return textureGather(uSecondColor, uv, 1);
        return textureGather(uSecondColor, uv, 2);
    }
    if (channel == 0)
        return layer == kRasterLayer ? textureGather(uColor, uv, 0)
                                     : textureGather(uLastColor, uv, 0);
    if (channel == 1)
        return layer == kRasterLayer ? textureGather(uColor, uv, 1)
                                     : textureGather(uLastColor, uv, 1);
    return layer == kRasterLayer ? textureGather(uColor, uv, 2) : textureGather(uLastColor, uv, 2);
}

/// Bilinear among the pixels of the entity, one of which holds the place.
vec3 interpolateColor(Seen seen) {
    if (seen.isInner) {
        vec2 uv = uvOf(seen.at);
        if (isSecond(seen.layer)) return textureLod(uSecondColorLinear, uv, 0.0f).rgb;
        return seen.layer == kRasterLayer ? textureLod(uColorLinear, uv, 0.0f).rgb
                                          : textureLod(uLastColorLinear, uv, 0.0f).rgb;
    }
    Footprint footprint = footprintOf(seen.at);
    vec4 weights =
        mix(vec4(0.0f), footprint.weights, gatherMatches(seen.layer, seen.key, seen.range, footprint));
    vec2 uv = gatherPlace(footprint);
    vec3 sum = vec3(
        dot(weights, gatherChannel(seen.layer, uv, 0)),
        dot(weights, gatherChannel(seen.layer, uv, 1)),
        dot(weights, gatherChannel(seen.layer, uv, 2))
    );
    return sum / dot(weights, vec4(1.0f));
}

/// A place at a pixel's centre has that pixel's bits.
vec3 colorOf(Seen seen) {
    if (kHasEdges && !seen.isInner) {
        ivec2 texel = ivec2(seen.at);
        if (isOfOther(seen.layer, seen.at, readSurface(seen.layer, texel)))
            return fetchOtherColor(texel);
    }
    return fract(seen.at) == vec2(0.5f) ? fetchColor(seen.layer, ivec2(seen.at))
                                        : interpolateColor(seen);
}

Candidate getCandidate(uint layer, uint tile, uint slot) {
    uvec4 read = layer == kLastLayer ? uLastTiles[tile].candidates[slot]
                                     : uRasterTiles[tile].candidates[slot];
    if (isSecond(layer)) read = uSecondTiles[tile].candidates[slot];
    return Candidate(read.x, read.y, read.z, read.w);
}

/// TileCandidates::ranges. \param index of a candidate, or kRangesMask
uint readRange(uint layer, uint tile, uint index) {
    if (isSecond(layer)) return uSecondTiles[tile].ranges[index];
    return layer == kLastLayer ? uLastTiles[tile].ranges[index] : uRasterTiles[tile].ranges[index];
}

TilePart getTilePart(uint layer, uint id) {
    if (isSecond(layer)) return uSecondParts[id];
    if (layer == kLastLayer) return uLastParts[id];
    return uRasterParts[id];
}

/// A bit for each candidate that the tile may see in that part of the exposure.
uint getPart(uint layer, uint tile, uint part) {
    if (isSecond(layer)) return uSecondTiles[tile].parts[part];
    return layer == kLastLayer ? uLastTiles[tile].parts[part] : uRasterTiles[tile].parts[part];
}

#endif
