// SPDX-License-Identifier: MIT
// Push constants of the gathers, behind MotionBlurParams.
#ifndef SHUTTER_GATHER_SHARED_H
#define SHUTTER_GATHER_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

// Specialisations of the gathers' pipelines (gather_taps.glsl).
SHUTTER_CONST uint kAnyTapCount = 0u; // as in the push constants
SHUTTER_CONST uint kAnyResponse = 0u; // as in the push constants
SHUTTER_CONST uint kBoxResponse = 1u;
SHUTTER_CONST uint kTableResponse = 2u; // not a box

struct GatherParams {
    float foregroundMagnification;
    float backgroundMagnification;
    float halfResolutionPx; // uniform motion from which two pixels along it are one
    float padding0;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::GatherParams) == 16);
#endif

#endif
