// SPDX-License-Identifier: MIT
#ifndef SHUTTER_DEPTH_OF_FIELD_SHARED_H
#define SHUTTER_DEPTH_OF_FIELD_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Side of a group of threads, pixels or tiles.
SHUTTER_CONST uint kLensGroup = 8u;

/// Tiles on each side of a pixel's own that its taps may come from.
SHUTTER_CONST int kReachTiles = 3;

struct LensFilterParams {
    uvec2 sizePx;
    uvec2 tileCount;
    uint tilePx; // side of a tile
    uint tapCount;
    float confusionPx;  // radius of the circle of confusion is this times |inverseFocus - 1/depth|
    float inverseFocus; // 1 / m
    // Read only by filters that trace rays:
    uvec2 frame;   // address of FrameConstants
    uint rayCount; // of each masked pixel
    uint firstRay; // of the pixel's sequence of places in the lens
};

/// What rays were traced for in a frame.
struct LensRayCounts {
    uint pixels;
    uint rays;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::LensFilterParams) == 48);
static_assert(sizeof(shutter::shader::LensRayCounts) == 8);
#endif

#endif
