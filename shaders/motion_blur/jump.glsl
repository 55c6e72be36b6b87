// SPDX-License-Identifier: MIT
// A jump is where one surface ends and another one, which moves differently, begins. Only near jumps can
// surfaces hide, pass or uncover each other. Jumps are found per pixel and stored per block.
#ifndef SHUTTER_MOTION_BLUR_JUMP_GLSL
#define SHUTTER_MOTION_BLUR_JUMP_GLSL

#include "common/numeric.glsl"
#include "motion_blur/motion_blur_shared.h"

SHUTTER_SHADER_BEGIN

/// Length of the steps of a search for jumps along a motion, pixels.
SHUTTER_CONST float kJumpStepPx = 8.0f;

/// Motions that differ by less are searched once, pixels.
SHUTTER_CONST float kAlikePx = 2.0f;

/// A jump marks all blocks within this distance of it, so that no step passes over one.
SHUTTER_CONST float kJumpReachPx = 0.5f * kJumpStepPx + kAlikePx;

/// Least difference of motion: less displaces a surface by less than a pixel shows.
SHUTTER_CONST float kJumpMotionPx = 0.25f;

/// Along motions of more than 512 pixels the steps are longer, and may miss a jump.
SHUTTER_CONST float kMaxJumpSteps = 64.0f;

SHUTTER_INLINE float countJumpSteps(vec2 motion) {
    return min(max(ceil(length(motion) / kJumpStepPx), 1.0f), kMaxJumpSteps);
}

// A mark is the depth of the nearer of the two surfaces, inverted so that the nearest is the greatest, and
// in its last bits the place of that surface relative to the block.
SHUTTER_CONST uint kNoJump = 0u;
SHUTTER_CONST uint kPlaceBits = 5u; // of each coordinate
SHUTTER_CONST uint kPlaceMask = 31u;
SHUTTER_CONST int kFirstPlace = -8; // pixels before the block's first

/// \param place relative to the block's first pixel, kFirstPlace to 23
SHUTTER_INLINE uint markJump(float nearerDepth, ivec2 place) {
    uint depth = ~floatBitsToUint(max(nearerDepth, 0.0f)) & ~((1u << (2u * kPlaceBits)) - 1u);
    return depth | uint(place.x - kFirstPlace) << kPlaceBits | uint(place.y - kFirstPlace);
}

/// Depth of the nearest surface at a jump, by up to a part in 8192 too small.
SHUTTER_INLINE float depthOfJump(uint mark) {
    return uintBitsToFloat(~(mark | ((1u << (2u * kPlaceBits)) - 1u)));
}

SHUTTER_INLINE ivec2 placeOfJump(uint mark) {
    return ivec2((mark >> kPlaceBits) & kPlaceMask, mark & kPlaceMask) + kFirstPlace;
}

SHUTTER_INLINE bool moveApart(vec2 a, vec2 b) {
    vec2 apart = a - b;
    return dot(apart, apart) >= kJumpMotionPx * kJumpMotionPx;
}

SHUTTER_SHADER_END

#endif
