// SPDX-License-Identifier: MIT
// Number and positions of the gather's taps. One pipeline serves all settings through push
// constants; one specialised for the number of taps and the kind of response allows the compiler to
// unroll the taps and fetch several at once. Before it: `params`.
#ifndef SHUTTER_MOTION_BLUR_GATHER_TAPS_GLSL
#define SHUTTER_MOTION_BLUR_GATHER_TAPS_GLSL

#include "motion_blur/gather_shared.h"
#include "motion_blur/taps.glsl"

// After the list's number and the shader's own constants.
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
