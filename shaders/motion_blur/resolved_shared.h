// SPDX-License-Identifier: MIT
// Interface between the passes of `resolved` and their shaders.
#ifndef SHUTTER_RESOLVED_SHARED_H
#define SHUTTER_RESOLVED_SHARED_H

#include "common/instant_motion_shared.h"

SHUTTER_SHADER_BEGIN

/// Pixels along the side of a tile that has a list of candidates: two blocks.
SHUTTER_CONST uint kCandidateTilePx = 16u;
/// Most entities that a tile's list holds.
SHUTTER_CONST uint kCandidatesPerTile = 32u;

/// Key of the sky; entities have the row of the entity table, which stays below. Keys have 24 bits:
/// a host's ids above those have kUnknownKey, whose motion is unknown.
SHUTTER_CONST uint kSkyKey = 0xFFFFFFu;
SHUTTER_CONST uint kUnknownKey = kSkyKey - 1u;
SHUTTER_CONST uint kNoKey = 0xFFFFFFFFu;

/// Parts of the exposure by which a tile's candidates are separated.
SHUTTER_CONST uint kExposureParts = 32u;

/// An entity, or a part of one that deforms, that a tile may see during the exposure. Every field
/// of an unused one has all bits set.
struct Candidate {
    uint key;              // row of its raster's entity table, kSkyKey, or kPartBit and a part
    uint nearest;          // bits of its least depth in the tile at any instant, metres
    uint farthestInverted; // inverted bits of the largest
    uint mover;            // in the table of movers, once they are sorted
};

SHUTTER_CONST uint kRangeWords = 64u;

struct TileCandidates {
    Candidate candidates[kCandidatesPerTile]; // nearest first once they are sorted
    // While they are listed: for each candidate a bit for each part of the exposure, 0 if it is in
    // the tile then. Once they are sorted: for each part a bit for each candidate, 1 if it is.
    uint parts[kExposureParts];
    // While they are listed: two words for each candidate, a bit for each parallax bin of its
    // surfaces, 0 if there is one (parallax_bins.glsl). Once they are sorted: a word for each
    // candidate, the range of depths in its raster that belongs to it; an entity that shows several
    // surfaces, one behind the other, is several candidates. Then, at kRangesMask, a bit for each
    // candidate that has less than all depths.
    uint ranges[kRangeWords];
};

SHUTTER_CONST uint kRangesMask = kCandidatesPerTile;

/// Rows of a group that sorts them, a tile for each thread: so many fit into 16 KiB, the shared
/// memory that every device has.
SHUTTER_CONST uint kSortRows = 3u;

/// Places that the search in a crowded tile begins at, most: one for each way of moving.
SHUTTER_CONST uint kCrowdSeeds = 30u;
SHUTTER_CONST uint kNoSeed = 0xFFFFFFFFu;

// Bits of TileCrowd::listed.
SHUTTER_CONST uint kTileIsListed = 1u; // 0: the tile is crowded, and its lists mean nothing
/// Shifted by the layer. 0: the layer has more entities in the tile than a list holds, and they are
/// in none.
SHUTTER_CONST uint kSourceIsListed = 2u;

/// Data of a tile and layer in a frame whose lists may overflow. Every field starts with all bits
/// set, and bits are only cleared: the result does not depend on the order of threads.
struct TileCrowd {
    uint listed;      // of the raster's layer, for all layers
    uint wayInverted; // inverted bits of the longest motion of surfaces that pass over the tile,
                      // pixels
    /// x | y << 16 of the first pixel of the layer's raster that moves that way; kNoSeed: none
    /// does.
    uint seeds[kCrowdSeeds];
};

/// A block of kGroupSize x kGroupSize pixels of this frame's raster as one plane: the sky, before a
/// perspective camera, belongs to the world, infinitely far away.
struct BlockPlane {
    uint keys;       // keyBit() of each key in it; 0 where nothing moves
    uint mover;      // of all its pixels; kNoMover: several, or of a mover without a plane;
                     // kDeformedMover: of one entity, whose key is `along`
    float along;     // at the block's centre: 1/metre (perspective) or metres
    vec2 slope;      // of `along`, per pixel
    float deviation; // greatest, of a pixel from the plane
};

/// Maximum number of instants with lookups per block.
SHUTTER_CONST uint kMaxBlockSamples = 32u;

/// The first entry of a block is a header: perX is the number of instants that its pixels take,
/// perY the bits of a float, their share of InstantNoise, [0, 1]. With a lens place.x is the
/// minimum diameter of the circles of confusion visible to the block, pixels.
///
/// With a lens there are two entries per sample: the middle set's place and, where that is a
/// plane, its change for another set (stepOfSet()): place.x is the screen shift of the block's
/// centre per unit of lens offset (zw of lensOf()), and perX, two halves, is PlaneMap::slope.
///
/// What a block samples in this frame's raster at an instant: a plane (PlaneMap), or
/// candidates.
struct BlockSample {
    vec2 place; // of the block's centre, pixels
    uint perX;  // two halves; kSearchedBlock: candidates are searched
    uint perY;  // two halves; or a bit for each of the tile's candidates that the block may see
};

SHUTTER_CONST uint kSearchedBlock = 0xFFFFFFFFu; // two NaN

/// Samples that rays may replace, by expected error: samples that no layer holds, then edges within
/// a pixel by the colours on both sides (within one entity, where colours are interpolated, by a
/// share of their contrast), then the rest.
SHUTTER_CONST uint kUnresolvedClass = 0u;
SHUTTER_CONST uint kFirstEdgeClass =
    1u; // colours that differ by a half and more; half of that; ...
SHUTTER_CONST uint kLastEdgeClass = 7u;
SHUTTER_CONST uint kOtherClass = 8u;
SHUTTER_CONST uint kSampleClasses = 9u;

SHUTTER_CONST uint kNoRayLimit = 0xFFFFFFFFu;

/// Sets of instants that pixels choose from with noise. Odd: the middle one is that of all pixels
/// without.
SHUTTER_CONST uint kInstantSets = 5u;
/// Greatest radius of the filter over pixels that have sets of a lens's places, pixels.
SHUTTER_CONST float kMaxLensFilterPx = 1.6f;
/// Side of the mask that they choose by; a power of two.
SHUTTER_CONST uint kNoiseSidePx = 64u;

// Bits of ResolvedParams::has.
SHUTTER_CONST uint kHasLastLayer = 1u;   // the last frame's raster
SHUTTER_CONST uint kHasSecondLayer = 2u; // the raster of the exposure's other end
/// Motion images of deforming entities (common/pixel_way.glsl), for all layers. Without them,
/// motion vectors are used, for this frame's raster alone.
SHUTTER_CONST uint kHasWays = 4u;
/// Each instant has a place of the lens: InstantMotions::lens.
SHUTTER_CONST uint kHasLensPlaces = 8u;
/// Pixels that have sets of such places are filtered (lens_filter.comp).
SHUTTER_CONST uint kFiltersLens = 16u;
/// Tiles may be crowded or have candidates with ranges of depths: their blocks are in a list of
/// their own.
SHUTTER_CONST uint kHasGeneralTiles = 32u;

struct ResolvedParams {
    uvec2 motions; // address of InstantMotions
    uint has;      // bits of kHasLastLayer and the others
    uint rayLimit; // of the frame; kNoRayLimit: none
    uvec2 frame;   // addresses of the scene's FrameConstants and TimedConstants: for rays only
    uvec2 timed;
    uvec2 noise;       // address of the mask, float[kNoiseSidePx^2] in [0, 1); 0: no noise
    float turn;        // added to the mask, modulo 1
    uint setCount;     // 1 without noise
    uint instantCount; // of the tables: sampleCount of each set; set s has s, s + setCount, ...
    /// Address of TileCrowd by layer and tile; 0: no tile can see more than its list holds.
    uvec2 crowds;
};

/// Counters of a frame.
struct ResolvedCounters {
    uint unresolved;   // instants of pixels that no layer explains
    uint fromSecond;   // instants of pixels that the raster of the exposure's other end explains
    uint fromLast;     // instants of pixels that the last frame's raster explains
    uint crowdedTiles; // that see more than their lists hold
    uint rays;         // traced
    uint classes[kSampleClasses];
    uint listedPixels; // entries of the list of pixels that rays may go to
    uint padding0;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::Candidate) == 16);
static_assert(sizeof(shutter::shader::TileCandidates) == 896);
static_assert(shutter::shader::kCandidatesPerTile == shutter::shader::kExposureParts);
static_assert(shutter::shader::kRangeWords == 2 * shutter::shader::kCandidatesPerTile);
static_assert(sizeof(shutter::shader::BlockPlane) == 24);
static_assert(sizeof(shutter::shader::BlockSample) == 16);
static_assert(sizeof(shutter::shader::TileCrowd) == 128);
static_assert(sizeof(shutter::shader::ResolvedParams) == 60);
static_assert(sizeof(shutter::shader::ResolvedCounters) == 64);
#endif

#endif
