// SPDX-License-Identifier: MIT
// Fewer rays than masked pixels: a quad of 2x2 pixels shares one, and below a quarter whole blocks
// leave the mask. Which blocks do so is the same in every frame, so that nothing flickers.
#ifndef SHUTTER_MOTION_BLUR_RAY_SHARE_GLSL
#define SHUTTER_MOTION_BLUR_RAY_SHARE_GLSL

#include "motion_blur/weights.glsl"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kTracePixels = 0u; // one ray per masked pixel
SHUTTER_CONST uint kTraceQuads = 1u;  // one ray per quad with masked pixels
SHUTTER_CONST uint kTraceNothing = 2u;

SHUTTER_CONST float kQuadShare = 0.25f; // of the rays, where every pixel of the quads is masked

/// Chooses how a block traces, so that all blocks together trace `rayShare` of the rays that the
/// mask requests.
/// \param block counted in blocks
SHUTTER_INLINE uint chooseTracing(vec2 block, float rayShare) {
    float noise = interleavedGradientNoise(block); // [0, 1)
    if (rayShare >= kQuadShare)
        return noise * (1.0f - kQuadShare) < rayShare - kQuadShare ? kTracePixels : kTraceQuads;
    return noise * kQuadShare < rayShare ? kTraceQuads : kTraceNothing;
}

SHUTTER_SHADER_END

#endif
