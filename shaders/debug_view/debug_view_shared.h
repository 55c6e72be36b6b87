// SPDX-License-Identifier: MIT
#ifndef SHUTTER_DEBUG_VIEW_SHARED_H
#define SHUTTER_DEBUG_VIEW_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kShowMotion = 0u;     // xy, pixels: hue is the direction, value the length
SHUTTER_CONST uint kShowDepth = 1u;      // z, metres: near is bright, logarithmic
SHUTTER_CONST uint kShowNormal = 2u;     // xyz, each [-1, 1]
SHUTTER_CONST uint kShowIds = 3u;        // a colour an id, black for none
SHUTTER_CONST uint kShowColor = 4u;      // linear light, cut off at 1
SHUTTER_CONST uint kShowMasks = 5u;      // channels as they are, [0, 1]
SHUTTER_CONST uint kShowGrey = 6u;       // x, [0, 1]
SHUTTER_CONST uint kShowHeat = 7u;       // x from 0 to heatMax: black, blue, red, yellow, white
SHUTTER_CONST uint kShowUnresolved = 8u; // masked pixels without another object behind

struct DebugViewParams {
    uvec2 sizePx; // of the picture
    uint kind;
    float longestPx; // kShowMotion: motion of full brightness
    float heatMax;   // kShowHeat
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::DebugViewParams) == 20);
#endif

#endif
