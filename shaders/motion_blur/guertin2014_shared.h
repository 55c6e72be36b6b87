// SPDX-License-Identifier: MIT
// Push constants of Guertin 2014, behind MotionBlurParams.
#ifndef SHUTTER_GUERTIN2014_SHARED_H
#define SHUTTER_GUERTIN2014_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

struct Guertin2014Params {
    float centreBias;       // kappa
    float speedThresholdPx; // gamma, of half velocities
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::Guertin2014Params) == 8);
#endif

#endif
