// SPDX-License-Identifier: MIT
// Push constants of the denoised method, behind MotionBlurParams.
#ifndef SHUTTER_DENOISED_SHARED_H
#define SHUTTER_DENOISED_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

struct DenoisedParams {
    uvec2 frame;          // address of the scene's FrameConstants
    uvec2 timed;          // address of the scene's TimedConstants
    float luminanceSigma; // standard deviations that count as noise
    float stepPx;         // between taps of one level
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::DenoisedParams) == 24);
#endif

#endif
