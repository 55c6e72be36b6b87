// SPDX-License-Identifier: MIT
// The list of samples that a host answers by its own means, as the passes around it agree on it.
#ifndef SHUTTER_OWN_SAMPLES_SHARED_H
#define SHUTTER_OWN_SAMPLES_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

struct SampleHeader {
    uint listed;   // samples in the list
    uint wanted;   // the same, with those that found no place
    uint capacity; // of the list
    uint padding0;
};

struct RequestedSample {
    uint pixel; // x | y << 16
    float time; // shutter time, [0, 1]
};

SHUTTER_CONST uint kNoSamples = 0xFFFFFFFFu;

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::SampleHeader) == 16);
static_assert(sizeof(shutter::shader::RequestedSample) == 8);
#endif

#endif
