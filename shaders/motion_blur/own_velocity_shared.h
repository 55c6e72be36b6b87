// SPDX-License-Identifier: MIT
// Push constants of own velocity, behind MotionBlurParams.
#ifndef SHUTTER_OWN_VELOCITY_SHARED_H
#define SHUTTER_OWN_VELOCITY_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

struct OwnVelocityParams {
    uint dropsOccluders; // 1: samples that may lie in front and do not reach the pixel are dropped
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::OwnVelocityParams) == 4);
#endif

#endif
