// SPDX-License-Identifier: MIT
// A raster with several samples per pixel as one surface per pixel and, at edges of movers, a
// second one.
#ifndef SHUTTER_SPLIT_SAMPLES_SHARED_H
#define SHUTTER_SPLIT_SAMPLES_SHARED_H

#include "common/shim.h"
#include "render/scene_shared.h"

SHUTTER_SHADER_BEGIN

/// Samples of a pixel, where more than one is drawn: Vulkan's standard locations.
SHUTTER_CONST uint kSampleCount = 4u;

/// Pixels per work group of split_edges.comp.
SHUTTER_CONST uint kSplitGroupSize = 64u;

/// Work groups in a row of its dispatch: devices may allow no more than 65,535 along an axis.
SHUTTER_CONST uint kSplitRow = 1024u;

/// Place of a sample from the pixel's upper left corner (Vulkan specification, "Multisampling").
SHUTTER_INLINE vec2 placeOfSample(uint index) {
    return vec2(
        index == 0u ? 0.375f : (index == 1u ? 0.875f : (index == 2u ? 0.125f : 0.625f)),
        0.125f + 0.25f * float(index)
    );
}

/// The sample whose place is nearest; of two as near, the first.
/// \param at place from the pixel's upper left corner
SHUTTER_INLINE uint nearestSample(vec2 at) {
    uint nearest = 0u;
    float least = 4.0f;
    for (uint i = 0u; i < kSampleCount; ++i) {
        vec2 away = at - placeOfSample(i);
        float square = away.x * away.x + away.y * away.y;
        if (square < least) {
            least = square;
            nearest = i;
        }
    }
    return nearest;
}

/// The word of an entity: its row in the low bits, of which the table has fewer; above them bits
/// that differ, as a rule, between triangles of one entity, then kSampleOfPart. Without an entity
/// it is kNoEntity.
SHUTTER_CONST uint kSampleRowBits = 24u;
SHUTTER_CONST uint kSampleOfPart = 0x80000000u; // the triangle covers only a part of the pixel

SHUTTER_INLINE uint rowOfSample(uint word) {
    return word == kNoEntity ? kNoEntity : word & ((1u << kSampleRowBits) - 1u);
}

/// A unit vector in two numbers of 16 bits, to 1e-4 rad (Meyer et al. 2010, "On Floating-Point
/// Normal Vectors", octahedral).
SHUTTER_INLINE uint packNormal(vec3 normal) {
    float sum = abs(normal.x) + abs(normal.y) + abs(normal.z);
    vec2 at = vec2(normal.x, normal.y) / sum;
    if (normal.z < 0.0f)
        at = vec2(
            (1.0f - abs(at.y)) * (at.x < 0.0f ? -1.0f : 1.0f),
            (1.0f - abs(at.x)) * (at.y < 0.0f ? -1.0f : 1.0f)
        );
    return packSnorm2x16(at);
}

SHUTTER_INLINE vec3 unpackNormal(uint bits) {
    vec2 at = unpackSnorm2x16(bits);
    vec3 normal = vec3(at, 1.0f - abs(at.x) - abs(at.y));
    float under = max(-normal.z, 0.0f);
    normal.x += normal.x < 0.0f ? under : -under;
    normal.y += normal.y < 0.0f ? under : -under;
    return normalize(normal);
}

struct SplitParams {
    uvec2 sizePx;
    uint keepsEdges; // 1: at an edge a pixel has its own surface's colour; 0: the mean
    uint hasBlended; // 1: blended surfaces were drawn, which are in colours alone
    uint hasNormals; // 0: normals are neither read nor written
    vec2 confusion;  // InstantMotions::confusion; 0: a pinhole
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::SplitParams) == 28);
#endif

#endif
