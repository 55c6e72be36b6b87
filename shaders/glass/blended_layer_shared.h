// SPDX-License-Identifier: MIT
// Interface between the draws of the blended layer and its shaders.
#ifndef SHUTTER_BLENDED_LAYER_SHARED_H
#define SHUTTER_BLENDED_LAYER_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Where an entity is at an instant.
struct LayerPlace {
    mat4 clipFromObject; // with the camera of that instant
    vec4
        relWorldFromObject[3]; // rows; camera-relative space of the raster instant (scene_shared.h)
};

/// Data shared by all draws of an instant.
struct LayerInstant {
    // Rows: from camera-relative space to the picture space in which depths are compared
    // (instant_motion_shared.h): of the instant's camera, or of the raster's.
    vec4 testFromRelWorld[3];
    float time; // shutter time, [0, 1]
    float weight;
    float padding0;
    float padding1;
};

/// How far behind the surface that hides it a blended surface still counts as on it, as a share of
/// the depth: decals, and the rounding of depths kept as halves.
SHUTTER_CONST float kLayerDepthSlack = 1.0e-3f;

/// Push constants.
struct LayerDraw {
    uvec2 frame; // address of FrameConstants
    uint entity;
    uint geometry;
    uvec2 place;   // address of LayerPlace
    uvec2 instant; // address of LayerInstant
    uint index;    // of the instant
    uint isPerspective;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::LayerPlace) == 112);
static_assert(sizeof(shutter::shader::LayerInstant) == 64);
static_assert(sizeof(shutter::shader::LayerDraw) == 40);
#endif

#endif
