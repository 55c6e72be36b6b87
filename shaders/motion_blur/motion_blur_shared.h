// SPDX-License-Identifier: MIT
// What the motion blur's passes and their shaders agree on.
#ifndef SHUTTER_MOTION_BLUR_SHARED_H
#define SHUTTER_MOTION_BLUR_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kGroupSize = 8u;      // pixel passes and tile max: 8 x 8 threads
SHUTTER_CONST uint kRevealThreads = 64u; // reveal: masked pixels a group

/// Motion shorter than this blurs less than a pixel shows: such pixels are still.
SHUTTER_CONST float kStillPx = 0.5f;

SHUTTER_CONST uint kObjectTestMeshId = 0u;
SHUTTER_CONST uint kObjectTestLuminance = 1u;

SHUTTER_CONST uint kRevealTraversalSingle = 0u;
SHUTTER_CONST uint kRevealTraversalStepping = 1u;

SHUTTER_CONST uint kOccluderTestNone = 0u;
SHUTTER_CONST uint kOccluderTestVelocity = 1u;

/// Push constants of every pass.
struct MotionBlurParams {
    uvec2 sizePx;
    uvec2 tileCount;
    uint tileSizePx;
    int neighbourRadius;           // tiles to each side
    uint sampleCount;
    float softDepthExtent;         // metres
    float edgeThreshold;           // [0, 1]
    float rasterShare;             // s of the raster instant, [0, 1]
    float foregroundMagnification;
    float backgroundMagnification;
    float jitter;                  // [0, 1]
    uint recursionLimit;
    uint objectTest;               // kObjectTest...
    float luminanceThreshold;
    uvec2 frame;                   // address of the scene's FrameConstants (reveal only)
    uint occluderTest;             // kOccluderTest... (own velocity only)
    float centreBias;              // kappa (Guertin only)
    float speedThresholdPx;        // gamma (Guertin only), of half velocities
    uvec2 moving;                  // address of the scene's MovingConstants (denoised only)
    float luminanceSigma;          // deviations that count as noise (denoised only)
    float stepPx;                  // between taps of one level (denoised only)
    uvec2 response;                // address of the shutter's ResponseTable; 0: a box
    uint revealTraversal;          // kRevealTraversal... (reveal only)
};

/// Arguments of the reveal's indirect dispatch (VkDispatchIndirectCommand).
struct RevealArguments {
    uint groupsX;
    uint groupsY;
    uint groupsZ;
};

/// Head of the list of masked pixels; the pixels (x | y << 16) follow.
struct MaskHeader {
    uint maskedPixels;
    uint raysTraced;
    uint padding0;
    uint padding1;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::MotionBlurParams) == 112);
static_assert(sizeof(shutter::shader::RevealArguments) == 12);
static_assert(sizeof(shutter::shader::MaskHeader) == 16);
#endif

#endif
