// SPDX-License-Identifier: MIT
// Panels over a host's picture that show the motion blur's inputs.
#ifndef SHUTTER_OVERLAY_SHARED_H
#define SHUTTER_OVERLAY_SHARED_H

#include "common/shim.h"
#include "motion_blur/prepare_shared.h"

SHUTTER_SHADER_BEGIN

// Panels, row by row; each is a quarter of the picture wide and high. The first four lie along the
// picture's top, the others along its bottom.
SHUTTER_CONST uint kPanelMotion = 0u;  // the motion that is blurred
SHUTTER_CONST uint kPanelCamera = 1u;  // the camera's part of it
SHUTTER_CONST uint kPanelObjects = 2u; // the remainder: object motion
SHUTTER_CONST uint kPanelDepth = 3u;   // near is bright
SHUTTER_CONST uint kPanelWorld = 4u;   // cells that are static in the world, of a metre or so
SHUTTER_CONST uint kPanelIds = 5u;     // a colour for each entity
SHUTTER_CONST uint kPanelNormal = 6u;
SHUTTER_CONST uint kPanelJitter = 7u; // a dot where the frame's samples lie in their pixels
SHUTTER_CONST uint kPanelCount = 8u;

struct OverlayTable {
    PrepareTable prepare; // of which the cameras and scales count
    /// Rows of the affine map from picture space (instant_motion_shared.h) to the world in cells,
    /// whose origin is moved by a multiple of two.
    vec4 worldFromPicture[3];
    vec2 jitterPx;
    uint panels; // bit i: panel i is drawn
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::OverlayTable) == 228);
#endif

#endif
