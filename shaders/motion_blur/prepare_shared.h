// SPDX-License-Identifier: MIT
// Conversion of a host's motion vectors and depth to the motion blur's conventions.
#ifndef SHUTTER_PREPARE_SHARED_H
#define SHUTTER_PREPARE_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Part of an image: texture coordinates of a place in the picture are origin + place * perPixel,
/// the place in pixels of the picture.
struct PrepareArea {
    vec2 origin;
    vec2 perPixel;
};

SHUTTER_CONST uint kPrepareHasCameras = 1u;        // beforeFromNow counts
SHUTTER_CONST uint kPreparePerspective = 2u;       // the camera is; else orthographic
SHUTTER_CONST uint kPrepareVectorsHaveCamera = 4u; // the camera's own motion is in the vectors
SHUTTER_CONST uint kPrepareSkyBeyond = 8u;      // sky: a value of skyValue and more, not it alone
SHUTTER_CONST uint kPrepareHasBlurScale = 16u;  // the image of scales counts
SHUTTER_CONST uint kPrepareHasVectors = 32u;    // the image of vectors counts; else they are 0
SHUTTER_CONST uint kPrepareDepthIsThird = 64u;  // depth is the third channel of its image
SHUTTER_CONST uint kPrepareHasViewModel = 128u; // viewModelRange counts

struct PrepareTable {
    /// Rows of the affine map from picture space (instant_motion_shared.h) now to that of the
    /// previous frame, for static surfaces.
    vec4 beforeFromNow[3];
    PrepareArea vectors;
    PrepareArea depth;
    PrepareArea blurScale;
    vec4 depthFromValue;     // metres = (x + y value) / (z + w value)
    vec4 viewModelFromValue; // the same within viewModelRange
    vec2 viewModelRange;     // lowest and highest value of depth of the view model's pixels
    vec2 pixelsPerUnit;      // of the vectors: to the picture's, right and down, from before to now
    vec2 jitterPx;           // the change of jitter included in the vectors, in the same direction
    float skyValue;          // background value of the depth image; NaN: there is none
    float cameraScale;       // share of the motion over a frame that is blurred
    float objectScale;       // the same for what objects move by themselves
    uint flags;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::PrepareArea) == 16);
static_assert(sizeof(shutter::shader::PrepareTable) == 168);
#endif

#endif
