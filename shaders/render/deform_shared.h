// SPDX-License-Identifier: MIT
// Mesh deformation: the vertices' joints and morph targets, and the jobs of one dispatch.
#ifndef SHUTTER_DEFORM_SHARED_H
#define SHUTTER_DEFORM_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kDeformThreads = 64u; // vertices or triangles a group

/// Four joints of one vertex.
struct JointInfluences {
    uvec2 joints; // 16 bits each, the first in the low half of x
    vec4 weights; // of a vertex's groups together the sum is 1
};

/// What one morph target adds to one vertex at weight 1.
struct MorphDelta {
    vec4 position; // xyz metres
    vec4 normal;   // xyz, added before normalising
    vec4 tangent;  // xyz, the same
};

/// One wave at one instant (scene::VertexWaves), object space.
struct WaveRow {
    vec4 displacement; // xyz metres of a crest, w phase in radians
    vec4 waveVector;   // xyz radians per metre
};

/// DeformJob::waveShare: the attribute that determines a vertex's share of the waves. Colour: the
/// number of its channel is added.
SHUTTER_CONST uint kWaveShareAll = 0u;
SHUTTER_CONST uint kWaveShareHeight = 1u;
SHUTTER_CONST uint kWaveShareColor = 2u;

/// Groups of a dispatch in x, below the guaranteed limit of 65535; y continues.
SHUTTER_CONST uint kDeformRow = 32768u;

/// The vertices of one geometry at a number of instants. A dispatch works off an array of them.
struct DeformJob {
    uvec2 vertices;   // address of Vertex[], undeformed
    uvec2 influences; // address of JointInfluences[]: influenceCount / 4 a vertex
    uvec2 deltas;     // address of MorphDelta[]: all vertices of the first target, then the next
    uvec2 joints;     // address of MotionKey[]: objectFromBind of all joints at the first instant,
                      // then at the next
    uvec2 weights;    // address of float[]: all targets' at the first instant, then at the next
    uvec2 output_;    // address of Vertex[] or vec4[]: all vertices at the first instant, ...
    uint vertexCount;
    uint influenceCount; // a multiple of 4; 0: all vertices are deformed by joint 0
    uint jointCount;     // 0: not skinned
    uint targetCount;    // 0: not morphed
    uint weightStride;   // weights an instant has, targetCount or more
    uint positionsOnly;  // 1: output_ is vec4[], xyz and w 1; 0: it is Vertex[]
    uint firstGroup;     // of the dispatch; the groups of all jobs before it come first
    uint waveCount;      // 0: no waves
    uvec2 waves;         // address of WaveRow[]: all waves at the first instant, then at the next
    uint waveShare;      // kWaveShare...
    float waveExponent;  // of the share, 1 or more
    vec4 waveHeight;     // kWaveShareHeight: the share is dot(xyz, p) + w, clamped to [0, 1]
};

/// Push constants.
struct DeformBatch {
    uvec2 jobs; // address of DeformJob[], by firstGroup; each has a vertex and an instant at least
    uint jobCount;
    uint groupCount; // of all jobs
};

/// Push constants: boxes over what triangles sweep between two keys of their shape (the dispatch's
/// y is the interval).
struct DeformedBoxJob {
    uvec2 vertices; // address of Vertex[]: all vertices at the first key, then at the next
    uvec2 indices;  // address of uint[]
    uvec2 boxes;    // address of float[]: six per triangle, min and max, in the order of indices
    uint boxStride; // triangles from one interval's boxes to the next one's
    uint vertexCount;
    uint triangleCount;
    uint padding0;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::JointInfluences) == 24);
static_assert(sizeof(shutter::shader::MorphDelta) == 48);
static_assert(sizeof(shutter::shader::WaveRow) == 32);
static_assert(sizeof(shutter::shader::DeformJob) == 112);
static_assert(sizeof(shutter::shader::DeformBatch) == 16);
static_assert(sizeof(shutter::shader::DeformedBoxJob) == 40);
#endif

#endif
