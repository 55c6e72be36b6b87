// SPDX-License-Identifier: MIT
// Shadow maps as the shading reads them. "Texels" are floats in a buffer rather than an image, so
// that raster and ray shaders with a frame's constants can access them without another binding.
#ifndef SHUTTER_SHADOW_SHARED_H
#define SHUTTER_SHADOW_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// ShadowLight::firstMap of a light that has no maps.
SHUTTER_CONST uint kNoShadowMap = 0xFFFFFFFFu;
/// ShadowLight::firstRun of a light that is not far away.
SHUTTER_CONST uint kNoShadowRun = 0xFFFFFFFFu;
/// Most instants of a CasterSpan.
SHUTTER_CONST uint kMaxRunInstants = 4u;
/// Texels to each side of a lookup's own that its filter may read.
SHUTTER_CONST float kShadowFilterTexels = 1.5f;

/// Texels from one row of a map to the next. Maps are a power of two wide, and caches keep few
/// lines whose addresses are such a power apart: a lookup's rows would drive one another out.
SHUTTER_INLINE uint shadowRowTexels(uint sizePx) {
    return sizePx + 16u;
}

/// One view of a light at a place. Depth is near / distance: 0 where there is no caster.
struct ShadowMap {
    mat4 clipFromRelWorld; // x, y in [-1, 1] over the map
    uint firstTexel;       // in ShadowConstants::texels; rows of shadowRowTexels(), top row first
    uint sizePx;           // width and height
    float texelMetres;     // width of a texel, metres: at clip w = 1
    uint padding0;
};

/// One view of a light that is far away: where the light's axes (ShadowLight::axes) lie in it.
/// Depth is linear and reversed: 1 nearest the light, 0 where there is no caster.
struct ShadowCascade {
    vec2 corner; // x and y of the origin of camera-relative space, texels
    float texelsPerMetre;
    float depthPerMetre; // towards the light
    float depth;         // of the origin, with its bias
    uint firstTexel;     // ShadowMap's
    uint sizePx;
    uint padding0;
};

/// Rounding of linear depths; those in perspective are rounded in proportion.
SHUTTER_CONST float kDepthRounding = 5.0e-7f;
/// The same of all depths, as a share.
SHUTTER_CONST float kDepthScaleRounding = 1.0e-6f;

/// Parallel to the rows of the table of lights.
struct ShadowLight {
    uint firstMap;   // of the light's maps, or kNoShadowMap: the light casts no shadows
    uint mapCount;   // directional: cascades, finest first; spot: 1; point: 6, +x -x +y -y +z -z
    uint firstLayer; // map of the first mover's first layer; the others follow
    uint firstRun;   // of the first mover's runs, or kNoShadowRun: the light has a place
    vec4 axes[3];    // xyz of a light that is far away: right, up and towards it, unit,
                     // camera-relative space
};

/// A moving caster with separate layers for each light: maps of it alone.
struct ShadowMover {
    vec4 sphere;       // xyz camera-relative space, w radius, metres: at the raster instant
    vec4 sweptSphere;  // the same over the whole exposure
    vec4 shape[3];     // rows of the form whose unit ellipsoid is the mover's box: alignPointRay()
    uint entity;       // row of the entity table
    uint firstInstant; // in the table of instants: instantCount rows, then partCount
    uint instantCount; // 1: it is static in the exposure; else ShadowConstants::instantCount
    uint firstLayer;   // counted from ShadowLight::firstLayer: the raster instant's
    /// Equal parts of the exposure that have a layer each, as in the middle of the part; they
    /// follow the raster instant's. 0: that one is for all.
    uint partCount;
    uint firstRun;    // counted from ShadowLight::firstRun: the raster instant's
    uint runInstants; // of each run over the exposure, which follow it: 1, 2 or kMaxRunInstants;
                      // the last one may go on beyond the exposure. 0: there are none
    uint padding0;
};

/// Where a mover is at one instant: takes points of camera-relative space to where they are as seen
/// from the mover at the raster instant. Rows of a 3x4 matrix.
struct ShadowInstant {
    vec4 rasterFromInstant[3];
};

/// Mapping from camera-relative space into a mover's layer at successive instants, for a
/// directional light: an affine map per instant, linear in the instant's number.
struct CasterSpan {
    vec4 first[3]; // rows of the first instant's: x and y in texels, depth with its bias
    vec4 step[3];  // added by each further instant
    vec4 slope[2]; // xyz: times a unit normal, over its cosine with the way to the light, it is the
                   // slope of a plane's depth, a texel, towards x and y
    uint firstTexel;
    uint sizePx;
    float texelMetres;
    uint padding0;
};

struct ShadowConstants {
    uvec2 texels;   // addresses: of float[]
    uvec2 lights;   // of ShadowLight[]
    uvec2 maps;     // of ShadowMap[], a row for each map
    uvec2 cascades; // of ShadowCascade[], too: the light's kind selects which of the two is read
    uvec2 movers;   // of ShadowMover[]
    uvec2 instants; // of ShadowInstant[]
    uvec2 runs;     // of CasterSpan[]
    uint lightCount;
    uint moverCount;
    uint instantCount; // 1: shadows as at the raster instant
    uint padding0;
};

/// Push constants of the draws into shadow maps.
struct ShadowDraw {
    mat4 clipFromObject;
    uvec2 frame;   // address of FrameConstants
    uint geometry; // row of the geometry table
    /// Deforming casters are drawn between their shape at the raster instant (0) and the one at
    /// shutter open (-1) or close (1).
    float shapeShift;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::ShadowMap) == 80);
static_assert(sizeof(shutter::shader::ShadowCascade) == 32);
static_assert(sizeof(shutter::shader::ShadowLight) == 64);
static_assert(sizeof(shutter::shader::ShadowMover) == 112);
static_assert(sizeof(shutter::shader::ShadowInstant) == 48);
static_assert(sizeof(shutter::shader::CasterSpan) == 144);
static_assert(sizeof(shutter::shader::ShadowConstants) == 72);
static_assert(sizeof(shutter::shader::ShadowDraw) == 80);
#endif

#endif
