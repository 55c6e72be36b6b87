// SPDX-License-Identifier: MIT
// What `resolved` leaves of a rectangle of the picture for overlays over it:
// the depth that each pixel saw at some instants of the exposure, and the colours of its parts. A
// buffer: an InstantSurfaces, then words of 32 bits.
#ifndef SHUTTER_INSTANT_SURFACES_GLSL
#define SHUTTER_INSTANT_SURFACES_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Maximum number of parts of the exposure with separate colours.
SHUTTER_CONST uint kMaxSurfaceParts = 4u;

struct InstantSurfaces {
    uvec2 originPx; // of the rectangle in the picture
    uvec2 sizePx;
    uint instantCount; // above 0
    uint partCount;    // of the exposure, up to kMaxSurfaceParts and instantCount
    uint padding0;
    uint padding1;
};

/// The `index`th of `count` instants taken out of `all`: spread evenly, and symmetric in time, so
/// that omitted instants do not displace the picture.
SHUTTER_INLINE uint takenInstant(uint index, uint count, uint all) {
    uint fromEnd = index < count - 1u - index ? index : count - 1u - index;
    uint taken = uint((float(fromEnd) + 0.5f) * (float(all) / float(count)));
    return fromEnd == index ? taken : all - 1u - taken;
}

/// Part of the exposure that an instant belongs to.
SHUTTER_INLINE uint surfacePartOf(InstantSurfaces head, uint instant) {
    return instant * head.partCount / head.instantCount;
}

/// Allocated size for a rectangle, rounded up in steps, so that a moving one reuses the images of
/// earlier frames.
SHUTTER_INLINE uvec2 sizeInSteps(uvec2 sizePx) {
    return (sizePx + 63u) / 64u * 64u;
}

SHUTTER_INLINE uint surfacePixels(InstantSurfaces head) { return head.sizePx.x * head.sizePx.y; }

/// Index of the word with a pixel's depths, two halves, metres along the view: of an even instant in the
/// low bits, of the next one in the high ones. Infinity: the sky.
SHUTTER_INLINE uint surfaceDepthWord(InstantSurfaces head, uint instant, uvec2 inRectangle) {
    return (instant / 2u) * surfacePixels(head) + inRectangle.y * head.sizePx.x + inRectangle.x;
}

/// Index of the first of two words with the mean colour of a part and how many instants it is of: four
/// halves. Of none: the pixel's whole mean counts.
SHUTTER_INLINE uint surfacePartWord(InstantSurfaces head, uint part, uvec2 inRectangle) {
    uint depths = (head.instantCount + 1u) / 2u * surfacePixels(head);
    uint pixel = part * surfacePixels(head) + inRectangle.y * head.sizePx.x + inRectangle.x;
    return depths + 2u * pixel;
}

SHUTTER_INLINE uint surfaceWordsPerPixel(InstantSurfaces head) {
    return (head.instantCount + 1u) / 2u + 2u * head.partCount;
}

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::InstantSurfaces) == 32);
#endif

#endif
