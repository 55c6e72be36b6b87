// SPDX-License-Identifier: MIT
// Data that the checker of a host's inputs reads back: totals over the picture, and samples of it.
#ifndef SHUTTER_CHECK_SHARED_H
#define SHUTTER_CHECK_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Samples lie in the middle of the cells of a grid over the picture.
SHUTTER_CONST uint kCheckAcross = 64u;
SHUTTER_CONST uint kCheckDown = 36u;
SHUTTER_CONST uint kCheckSamples = 2304u; // across times down
/// Depth and ids are taken at more pixels, in which the next frame's surfaces are looked up: of a
/// picture that has fewer columns or rows, at all of them.
SHUTTER_CONST uint kCheckFineAcross = 256u;
SHUTTER_CONST uint kCheckFineDown = 144u;
SHUTTER_CONST uint kCheckFinePixels = 36864u; // across times down
/// Rows of entities below this are searched in the picture.
SHUTTER_CONST uint kCheckRows = 65536u;
SHUTTER_CONST uint kCheckRowWords = 2048u; // a bit for each

/// A pixel as the host's images have it.
struct CheckSample {
    vec2 vector;
    float depth;
    uint id;
    vec4 deformed; // ShutterBlurInputs::deformedMotion
};

// Indices of CheckTotals::counts: pixels of which ...
SHUTTER_CONST uint kCheckColorNan = 0u;      // a channel of the colour is NaN
SHUTTER_CONST uint kCheckColorInfinite = 1u; // one is infinite
SHUTTER_CONST uint kCheckColorNegative = 2u; // one is below 0
SHUTTER_CONST uint kCheckMotionNan = 3u;
SHUTTER_CONST uint kCheckMotionInfinite = 4u;
SHUTTER_CONST uint kCheckMotionBeyond = 5u; // the motion is longer than the picture's diagonal
SHUTTER_CONST uint kCheckDepthNan = 6u;
SHUTTER_CONST uint kCheckDepthInfinite = 7u;
SHUTTER_CONST uint kCheckDepthNegative = 8u;
SHUTTER_CONST uint kCheckDepthZero = 9u;
SHUTTER_CONST uint kCheckDepthOne = 10u;
SHUTTER_CONST uint kCheckDepthAboveOne = 11u;
SHUTTER_CONST uint kCheckDepthSky = 12u;
SHUTTER_CONST uint kCheckIdNone = 13u;
SHUTTER_CONST uint kCheckIdBeyond = 14u;        // the id is no row
SHUTTER_CONST uint kCheckBlendedNan = 15u;      // a channel of `blended` is NaN or infinite
SHUTTER_CONST uint kCheckBlendedNegative = 16u; // a colour of it is below 0
SHUTTER_CONST uint kCheckBlendedOpacity = 17u;  // its alpha is outside of [0, 1]
SHUTTER_CONST uint kCheckCounts = 20u;

struct CheckTotals {
    uint serial;     // of the recording
    uint depthLeast; // bits of the least and the greatest depth that are 0 or above
    uint depthMost;
    uint padding;
    uint counts[kCheckCounts];
    uint seenRows[kCheckRowWords]; // a bit for each row
    CheckSample samples[kCheckSamples];
    float fineDepths[kCheckFinePixels]; // row by row of fineGrid() (check_grid.glsl)
    uint fineIds[kCheckFinePixels];
};

SHUTTER_CONST uint kCheckDepthIsThird = 1u; // depth is the third channel of its image
SHUTTER_CONST uint kCheckSkyIsBeyond = 2u;  // depths of skyValue and more are the sky, too
SHUTTER_CONST uint kCheckHasVectors = 4u;   // the image of vectors counts; else they are 0

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::CheckSample) == 32);
static_assert(sizeof(shutter::shader::CheckTotals) == 376928);
static_assert(
    shutter::shader::kCheckSamples == shutter::shader::kCheckAcross * shutter::shader::kCheckDown
);
static_assert(
    shutter::shader::kCheckFinePixels ==
    shutter::shader::kCheckFineAcross * shutter::shader::kCheckFineDown
);
static_assert(shutter::shader::kCheckRowWords * 32u == shutter::shader::kCheckRows);
#endif

#endif
