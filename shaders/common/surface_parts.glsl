// SPDX-License-Identifier: MIT
// Colours of the exposure's parts out of `uHead` and `uWords`, the buffer of an InstantSurfaces,
// which the including shader declares before.
#ifndef SHUTTER_SURFACE_PARTS_GLSL
#define SHUTTER_SURFACE_PARTS_GLSL

/// rgb: mean colour of a part; a: of how many instants.
vec4 colorOfPart(uint part, uvec2 inRectangle) {
    uint word = surfacePartWord(uHead, part, inRectangle);
    return vec4(unpackHalf2x16(uWords[word]), unpackHalf2x16(uWords[word + 1u]));
}

/// The background in a part. \param picture mean of all parts, used if the part has none
vec3 behindPart(uint part, uvec2 inRectangle, vec3 picture) {
    vec4 own = colorOfPart(part, inRectangle);
    return own.a > 0.0f ? own.rgb : picture;
}

#endif
