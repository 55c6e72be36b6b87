// SPDX-License-Identifier: MIT
#ifndef SHUTTER_TAA_SHARED_H
#define SHUTTER_TAA_SHARED_H

#include "common/instant_motion_shared.h"
#include "common/shim.h"

SHUTTER_SHADER_BEGIN

struct TaaParams {
    uvec2 sizePx;
    vec2 jitterPx;      // of this frame's raster: right and down, in its pixels
    LayerMotion last;   // by row of this frame: from its picture space to the last one's
    float leastShare;   // of this frame in what is kept, (0, 1]
    float motionScale;  // time since the last frame in exposures, for what deforms
    uint hasLast;       // 1: the last picture says something about this frame
    uint isPerspective; // 1: the camera is
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::TaaParams) == 56);
#endif

#endif
