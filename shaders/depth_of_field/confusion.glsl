// SPDX-License-Identifier: MIT
// Circle of confusion by depth, and the taps of a disc.
#ifndef SHUTTER_DEPTH_OF_FIELD_CONFUSION_GLSL
#define SHUTTER_DEPTH_OF_FIELD_CONFUSION_GLSL

#include "common/numeric.glsl"
#include "depth_of_field/depth_of_field_shared.h"

SHUTTER_SHADER_BEGIN

/// Area of a disc of radius 1.
SHUTTER_CONST float kUnitDiscArea = 3.14159265f;

/// Below it a circle of confusion lies within the pixel.
SHUTTER_CONST float kSharpPx = 0.5f;

/// Radius of the circle of confusion, pixels: negative in front of the focus plane, positive
/// behind, at most the reach of the tiles. 0 for a depth that is NaN or not above 0.
/// \param depth metres
SHUTTER_INLINE float confusionRadius(LensFilterParams params, float depth) {
    if (!isFinite(depth) || depth <= 0.0f) return 0.0f;
    float most = float(params.tilePx) * float(kReachTiles);
    return clamp(params.confusionPx * (params.inverseFocus - 1.0f / depth), -most, most);
}

/// Tap i of count on a unit disc: equal areas, turned by the golden angle from one to the next (Vogel
/// 1979). \param turn radians, a pixel's own
SHUTTER_INLINE vec2 discTap(uint i, uint count, float turn) {
    float angle = float(i) * 2.39996323f + turn;
    return sqrt((float(i) + 0.5f) / float(count)) * vec2(cos(angle), sin(angle));
}

SHUTTER_SHADER_END

#endif
