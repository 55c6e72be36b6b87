// SPDX-License-Identifier: MIT
// What rays at any time of the exposure read. Shutter time s runs from 0 (open) to 1 (close); eye
// space is scene_shared.h's, with its origin where the camera is at the raster instant, at all s.
#ifndef SHUTTER_MOVING_SCENE_SHARED_H
#define SHUTTER_MOVING_SCENE_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// A 3x4 matrix at one shutter time, row by row.
struct MotionKey {
    vec4 rows[3];
};

/// Parallel to the rows of the entity table.
struct TimedRow {
    uvec2 keys;         // address of MotionKey[]: relWorldFromObject
    uint keyCount;      // 1: it is static; else uniform over s, both ends included
    uint firstGeometry; // as EntityRow's
    uvec2 meshScene;    // address of the mesh's own top level, object space; 0 where it is static
    uint deformationKeyCount; // 1: the shape is static; else uniform over s, both ends included:
                              // then meshScene is the address of uvec2[], a top level for each two
                              // keys, and the geometries' Vertex[] hold one key's vertices behind
                              // the other's
    float handedness;         // -1 where a mirrored skeleton turns the winding round, else 1
};

/// The camera's lens at one shutter time.
struct LensKey {
    float radius; // half the height of its opening, metres
    float focus;  // 1 / focus distance, 1/m
};

struct TimedConstants {
    vec4 view;        // x, y: half the view's width and height at the raster instant, at distance 1
                      // (perspective) or anywhere (orthographic); z: near plane, metres; w: 1
                      // perspective, 0 not
    uvec2 rows;       // address of TimedRow[]
    uvec2 boxes;      // address of uint[]: row of the entity table of each moving box
    uvec2 cameraKeys; // address of MotionKey[]: relWorldFromView; rigid except for x and y, which a
                      // zooming lens scales by how much wider it sees than at the raster instant
    uvec2 lights;     // address of LightRow[]: all lights at the first key, then at the next, ...
    uint cameraKeyCount;
    uint lightKeyCount;
    uint lightCount;
    uint lensKeyCount; // 0: a pinhole
    uvec2 lensKeys;    // address of LensKey[], uniform over s, both ends included
    vec4 aperture;     // Aperture's fields
    vec2 jitterPx;     // from the middle of a pixel to where the picture samples it, right and down
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::MotionKey) == 48);
static_assert(sizeof(shutter::shader::TimedRow) == 32);
static_assert(sizeof(shutter::shader::LensKey) == 8);
static_assert(sizeof(shutter::shader::TimedConstants) == 96);
#endif

#endif
