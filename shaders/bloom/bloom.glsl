// SPDX-License-Identifier: MIT
// Which light the lens scatters.
#ifndef SHUTTER_BLOOM_GLSL
#define SHUTTER_BLOOM_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Share of a colour that lies above the threshold, [0, 1]. Around it the share rises as a parabola, so
/// that what brightens begins to glow little by little.
/// \param peak the colour's largest channel
/// \param threshold in the same unit, 0 or more; 0, with a knee of 0: all of the colour
/// \param knee how far below and above the threshold the parabola reaches, [0, threshold]
SHUTTER_INLINE float findHighlightShare(float peak, float threshold, float knee) {
    const float least = 1.0e-7f; // in place of 0, by which nothing is divided
    float soft = clamp(peak - threshold + knee, 0.0f, 2.0f * knee);
    float above = max(soft * soft / max(4.0f * knee, least), peak - threshold);
    return above / max(peak, least);
}

/// The part of a colour that the lens scatters.
SHUTTER_INLINE vec3 findHighlight(vec3 color, float threshold, float knee) {
    float peak = max(max(color.x, color.y), color.z);
    return color * findHighlightShare(peak, threshold, knee);
}

SHUTTER_SHADER_END

#endif
