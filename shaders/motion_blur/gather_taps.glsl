// SPDX-License-Identifier: MIT
// How many taps the gathers take, and where. One pipeline serves all settings by the push constants;
// one that is made for the number of taps and for the kind of response lets the compiler unroll the
// taps and fetch several at once. Before it: `params`.
#ifndef SHUTTER_MOTION_BLUR_GATHER_TAPS_GLSL
#define SHUTTER_MOTION_BLUR_GATHER_TAPS_GLSL

#include "motion_blur/gather_shared.h"
#include "motion_blur/taps.glsl"

// Behind the list's number and what a shader has of its own.
layout(constant_id = 2) const uint kTapCount = kAnyTapCount;
layout(constant_id = 3) const uint kResponse = kAnyResponse;

uint countTaps() { return kTapCount != kAnyTapCount ? kTapCount : params.sampleCount; }

/// Where the response has the tap that is at `even` under a box, u.
float respondToTap(float even) {
    if (kResponse == kBoxResponse) return even;
    if (kResponse == kTableResponse)
        return warpTap(ResponseRef(params.response), even, params.rasterTime);
    return warpTapAt(params.response, even, params.rasterTime);
}

#endif
