// SPDX-License-Identifier: MIT
// Where a layer's surfaces are at an instant of the exposure (common/instant_motion_shared.h). A
// layer is a raster image: one of this frame's or the last one's.
#ifndef SHUTTER_RESOLVED_GLSL
#define SHUTTER_RESOLVED_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require

#include "common/instant_surfaces.glsl"
#include "common/picture_space.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/parallax_bins.glsl"
#include "motion_blur/resolved_shared.h"
#include "render/scene_shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer InstantMotionsRef {
    InstantMotions value;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MoverTable {
    uint movers[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RowTable {
    uint rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer InstantMotionTable {
    InstantMotion motions[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ParallaxTable {
    float parallaxes[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer InstantTable {
    float times[];
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LensShiftTable {
    vec4 shifts[];
};

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer LensPlaceTable {
    vec2 places[];
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LensReachTable {
    LensReach reaches[];
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer NoiseMask {
    float shares[];
};

const uint kRasterLayer = 0u;
const uint kLastLayer = 1u;
const uint kSecondLayer = 2u; // the exposure's other end

/// Tiles that have a list of candidates, across and down.
uvec2 countTiles(uvec2 sizePx) { return (sizePx + kCandidateTilePx - 1u) / kCandidateTilePx; }

/// \param bits of ResolvedParams::has
bool has(ResolvedParams method, uint bits) { return (method.has & bits) != 0u; }

LayerMotion getLayer(InstantMotionsRef motions, uint index) {
    LayerMotion layer = motions.value.raster;
    if (index == kLastLayer) layer = motions.value.last;
    if (index == kSecondLayer) layer = motions.value.second;
    return layer;
}

/// Shutter time of an instant.
float timeOf(InstantMotionsRef motions, uint instant) {
    return InstantTable(motions.value.times).times[instant];
}

/// Displacement by an instant's place of the lens, for lensShift(). There must be a lens.
vec4 lensOf(InstantMotionsRef motions, uint instant) {
    return LensShiftTable(motions.value.lens).shifts[instant];
}

/// Pixels, at a depth.
vec2 lensShift(vec4 lens, float depth) { return lens.xy + lens.zw / max(depth, kMinDepth); }

/// Where the places of the lens lie that a sample is taken at; of the number of samples: of all.
LensReach reachOf(InstantMotionsRef motions, uint sample_) {
    return LensReachTable(motions.value.lensReaches).reaches[sample_];
}

/// Least and greatest shift that such places have between two depths, pixels. \param alongs 1 / depth
vec4 lensShifts(LensReach reach, vec2 alongs) {
    vec4 a = vec4(reach.low, reach.high) * (alongs.x - reach.inverseFocus);
    vec4 b = vec4(reach.low, reach.high) * (alongs.y - reach.inverseFocus);
    return vec4(min(min(a.xy, a.zw), min(b.xy, b.zw)), max(max(a.xy, a.zw), max(b.xy, b.zw)));
}

uint findMover(LayerMotion layer, uint key) {
    if (key == kSkyKey) return kSkyMover;
    return key < layer.rowCount ? MoverTable(layer.movers).movers[key] : kNoMover;
}

/// As a place of the lens sees it. \param lens lensOf()
InstantMotion shearMotion(InstantMotion motion, uint mover, vec4 lens) {
    if (mover == kSkyMover) lens.zw = vec2(0.0f); // it is infinitely far away
    for (uint row = 0u; row < 3u; ++row) {
        vec2 perPixel = motion.rasterFromInstant[row].xy;
        motion.rasterFromInstant[row].z -= dot(perPixel, lens.xy);
        motion.rasterFromInstant[row].w -= dot(perPixel, lens.zw);
    }
    for (uint axis = 0u; axis < 2u; ++axis) {
        motion.instantFromRaster[axis] += lens[axis] * motion.instantFromRaster[2];
        motion.instantFromRaster[axis].w += lens[axis + 2u];
    }
    return motion;
}

/// A rigid mover at a sample's time, for the pinhole in the lens's middle. There must be a lens.
InstantMotion pinholeMotion(ResolvedParams method, LayerMotion layer, uint mover, uint sample_) {
    return InstantMotionTable(layer.motions).motions[mover * (method.instantCount / kLensSets) + sample_];
}

/// A rigid mover at an instant.
/// \param hasLens each instant has a place of the lens
InstantMotion motionAt(
    ResolvedParams method, bool hasLens, LayerMotion layer, uint mover, uint instant
) {
    if (!hasLens) return InstantMotionTable(layer.motions).motions[mover * method.instantCount + instant];
    return shearMotion(
        pinholeMotion(method, layer, mover, instant / kLensSets), mover,
        lensOf(InstantMotionsRef(method.motions), instant)
    );
}

bool isStillMover(LayerMotion layer, uint mover) {
    return layer.isStatic != 0u && (mover == kWorldMover || mover == kSkyMover);
}

/// A direction has no place: its depth is 1 and it is not displaced.
float depthOfKey(uint key, float depth) { return key == kSkyKey ? 1.0f : depth; }

// A pixel of a surface image: bits of the depth; key, a bit for each corner of the pixel, set if the
// four pixels that meet there are of one entity, and a bit for each sample that another surface covers
// (render/split_samples_shared.h).
const uint kKeyBits = 0xFFFFFFu;
const uint kKeyBitCount = 24u;
const uint kCornerShift = 24u;
const uint kSampleShift = 28u;

/// LayerMotion::parallaxes.
float parallaxOf(LayerMotion layer, uint key) {
    return key < layer.rowCount ? ParallaxTable(layer.parallaxes).parallaxes[key] : 0.0f;
}

/// Bit of a set of keys; some share one.
uint keyBit(uint key) { return 1u << (key & 31u); }

uint keyOf(uvec2 surface) { return surface.y & kKeyBits; }
uint innerCornersOf(uvec2 surface) { return surface.y >> kCornerShift & 0xFu; }
uint otherSamplesOf(uvec2 surface) { return surface.y >> kSampleShift; }

/// \param id of an image of entity ids
uint keyOfId(uint id) { return id == kNoEntity ? kSkyKey : min(id, kUnknownKey); }

const uint kAllCorners = 0xFu;

/// \param at place from the pixel's upper left corner
/// \return whether the four pixels around the place are of one entity
bool isInner(uint corners, vec2 at) {
    uint corner = (at.x < 0.5f ? 0u : 1u) + (at.y < 0.5f ? 0u : 2u);
    return (corners >> corner & 1u) != 0u;
}

/// Sample position of a pixel of a block. \param inBlock from the block's centre, pixels
vec2 samplePlace(BlockSample blockSample, vec2 inBlock) {
    return blockSample.place + unpackHalf2x16(blockSample.perX) * inBlock.x +
           unpackHalf2x16(blockSample.perY) * inBlock.y;
}

/// Parts of the exposure for each instant, in fixed point for partOf(). With a lens at most one for each
/// sample.
uint partsPerInstant(ResolvedParams method) {
    uint parts = (kExposureParts << 16u) / max(method.instantCount, kExposureParts);
    return has(method, kHasLensPlaces) ? min(parts, (1u << 16u) / kLensSets) : parts;
}

/// Part of the exposure that an instant belongs to.
uint partOf(uint instant, uint partsPerInstant_) { return instant * partsPerInstant_ >> 16u; }

/// The set of instants that all pixels take without noise.
uint middleSet(ResolvedParams method) {
    return has(method, kHasLensPlaces) ? kMiddleLensSet : method.setCount / 2u;
}

/// One of kLensSets for each of 4 x 4 pixels: four that follow one another for 2 x 2.
uint lensSetOf(uvec2 pixel) {
    uvec2 turn = uvec2((pixel.x ^ pixel.y) & 3u, pixel.y & 3u);
    uint fine = (turn.x & 1u) << 1u | (turn.y & 1u);
    return (turn.x >> 1u) << 3u | (turn.y >> 1u) << 2u | fine;
}

/// Entries of a block in the table of BlockSample.
uint looksPerBlock(ResolvedParams method) {
    uint firstSample = has(method, kHasLensPlaces) ? 2u * (method.instantCount / kLensSets) : method.instantCount;
    return firstSample + 1u;
}

/// Which of the sets of instants a pixel takes.
/// \param amount of the noise, [0, 1]; 0: the middle set
uint findSet(ResolvedParams method, ivec2 pixel, float amount) {
    if (method.setCount == 1u) return 0u;
    if (has(method, kHasLensPlaces)) return amount > 0.0f ? lensSetOf(uvec2(pixel)) : kMiddleLensSet;
    uvec2 at = uvec2(pixel) % kNoiseSidePx;
    float share = fract(NoiseMask(method.noise).shares[at.y * kNoiseSidePx + at.x] + method.turn);
    float sets = (0.5f + (share - 0.5f) * amount) * float(method.setCount);
    return min(uint(sets), method.setCount - 1u);
}

#endif
