// SPDX-License-Identifier: MIT
// What the passes of `resolved` and their shaders agree on.
#ifndef SHUTTER_RESOLVED_SHARED_H
#define SHUTTER_RESOLVED_SHARED_H

#include "common/instant_motion_shared.h"

SHUTTER_SHADER_BEGIN

/// Pixels along the side of a tile that has a list of candidates: two blocks.
SHUTTER_CONST uint kCandidateTilePx = 16u;
/// Most entities that a tile's list holds.
SHUTTER_CONST uint kCandidatesPerTile = 32u;

/// Key of the sky; entities have the row of the entity table, which stays below. Keys have 24 bits:
/// what a host gives larger ids than any row has kUnknownKey, of which nothing is known.
SHUTTER_CONST uint kSkyKey = 0xFFFFFFu;
SHUTTER_CONST uint kUnknownKey = kSkyKey - 1u;
SHUTTER_CONST uint kNoKey = 0xFFFFFFFFu;

/// Parts of the exposure that a tile's candidates are told apart by.
SHUTTER_CONST uint kExposureParts = 32u;

/// An entity, or a part of one that deforms, that a tile may see during the exposure. Every field
/// of an unused one has all bits set.
struct Candidate {
    uint key;              // row of its raster's entity table, kSkyKey, or kPartBit and a part
    uint nearest;          // bits of its least depth in the tile at any instant, metres
    uint farthestInverted; // inverted bits of the largest
    uint mover;            // in the table of movers, once they are sorted
};

struct TileCandidates {
    Candidate candidates[kCandidatesPerTile]; // nearest first once they are sorted
    // While they are listed: for each candidate a bit for each part of the exposure, 0 if it is in
    // the tile then. Once they are sorted: for each part a bit for each candidate, 1 if it is.
    uint parts[kExposureParts];
};

/// What a block of kGroupSize x kGroupSize pixels of this frame's raster shows, as one plane: the
/// sky, before a perspective camera, belongs to the world, infinitely far away.
struct BlockPlane {
    uint keys;       // keyBit() of each key in it; 0 where nothing moves
    uint mover;      // of all its pixels; kNoMover: several, or of a mover without a plane;
                     // kDeformedMover: of one entity, whose key is `along`
    float along;     // at the block's centre: 1/metre (perspective) or metres
    vec2 slope;      // of `along`, per pixel
    float deviation; // greatest, of a pixel from the plane
};

/// Most instants for which what a block looks at is found for all its pixels together.
SHUTTER_CONST uint kMostLooks = 32u;

/// Before the looks of a block stands one whose perX is how many instants its pixels take, and perY
/// the bits of a float: how much of InstantNoise they take them with, [0, 1].
///
/// What a block looks at in this frame's raster at an instant: a plane (PlaneMap), or candidates.
struct BlockLook {
    vec2 place; // of the block's centre, pixels
    uint perX;  // two halves; kSearchedLook: candidates are searched
    uint perY;  // two halves; or a bit for each of the tile's candidates that the block may see
};

SHUTTER_CONST uint kSearchedLook = 0xFFFFFFFFu; // two NaN

/// Samples that rays may replace, by the harm that leaving them does: what no layer explains, then
/// edges within a pixel by the colours on both sides (within one entity, where colours are
/// interpolated, by a share of their contrast), then the rest.
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
/// Side of the mask that they choose by; a power of two.
SHUTTER_CONST uint kNoiseSidePx = 64u;

struct ResolvedParams {
    uvec2 motions;  // address of InstantMotions
    uint hasLast;   // 1: the last frame's raster is a layer
    uint hasSecond; // 1: the raster of the exposure's other end is a layer
    uint rayLimit;  // of the frame; kNoRayLimit: none
    uvec2 frame;    // addresses of the scene's FrameConstants and TimedConstants: for rays only
    uvec2 timed;
    uvec2 noise;       // address of the mask, float[kNoiseSidePx^2] in [0, 1); 0: no noise
    float turn;        // added to the mask, modulo 1
    uint setCount;     // 1 without noise
    uint instantCount; // of the tables: sampleCount of each set; set s has s, s + setCount, ...
    uint hasWays; // 1: images say where what deforms goes (common/pixel_way.glsl), of all layers;
                  // 0: motion vectors do, of this frame's raster
};

/// What a frame counted.
struct ResolvedCounters {
    uint unresolved; // instants of pixels that no layer explains
    uint fromSecond; // instants of pixels that the raster of the exposure's other end explains
    uint fromLast;   // instants of pixels that the last frame's raster explains
    uint overflown;  // candidates that found no place in a tile's list
    uint rays;       // traced
    uint classes[kSampleClasses];
    uint listedPixels; // entries of the list of pixels that rays may go to
    uint padding0;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::Candidate) == 16);
static_assert(sizeof(shutter::shader::TileCandidates) == 640);
static_assert(shutter::shader::kCandidatesPerTile == shutter::shader::kExposureParts);
static_assert(sizeof(shutter::shader::BlockPlane) == 24);
static_assert(sizeof(shutter::shader::BlockLook) == 16);
static_assert(sizeof(shutter::shader::ResolvedParams) == 60);
static_assert(sizeof(shutter::shader::ResolvedCounters) == 64);
#endif

#endif
