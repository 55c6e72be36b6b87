// SPDX-License-Identifier: MIT
// Push constants of the ray mask and the reveal, behind MotionBlurParams.
#ifndef SHUTTER_HYBRID_SHARED_H
#define SHUTTER_HYBRID_SHARED_H

#include "common/shim.h"
#include "motion_blur/gather_shared.h"

SHUTTER_SHADER_BEGIN

// Bits of HybridParams::flags.
SHUTTER_CONST uint kFlagLuminanceTest = 1u;  // objects are distinguished by luminance, not by id
SHUTTER_CONST uint kFlagSteppingReveal = 2u; // the reveal steps from surface to surface
SHUTTER_CONST uint kFlagRelativeMask = 4u;   // masked only where the background moves relative to
                                             // the foreground

struct HybridParams {
    GatherParams gather;
    float edgeThreshold; // [0, 1]
    float rayShare;      // of the masked pixels that trace, [0, 1]
    float luminanceThreshold;
    uint recursionLimit;
    uvec2 frame; // address of the scene's FrameConstants
    uint flags;  // kFlag...
    uint padding0;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::HybridParams) == 48);
#endif

#endif
