// SPDX-License-Identifier: MIT
// The image of a lens's opening that a point of light out of focus makes, per pixel.
#ifndef SHUTTER_DISC_SHARE_GLSL
#define SHUTTER_DISC_SHARE_GLSL

#include "common/aperture.glsl"

SHUTTER_SHADER_BEGIN

/// How far a place lies inside the opening's image, pixels; negative: outside.
/// \param from the disc's middle
SHUTTER_INLINE float insideDisc(Aperture aperture, vec2 from, float confusion) {
    vec2 place = vec2(from.x / aperture.squeeze, -from.y) / confusion;
    float radius = max(length(place), 1.0e-6f);
    float angle = place != vec2(0.0f) ? atan(place.y, place.x) : 0.0f; // undefined there
    vec2 border = apertureBorder(aperture, angle);
    // Where the opening is squeezed, distances across its border are as well.
    float squeezed = length(vec2(place.x / aperture.squeeze, place.y)) / radius;
    return (border.x - radius) * border.y * abs(confusion) / max(squeezed, 1.0e-6f);
}

/// Light of a pixel of the disc per light of its point. At the border it is the mean of 2 x 2 places: the
/// pixels of a small disc would not have its light else.
/// \param from the disc's middle
/// \param area apertureArea()
/// \param width over which the border rises at each place
SHUTTER_INLINE float shareOfDisc(Aperture aperture, vec2 from, float confusion, float area, float width) {
    // A border that rises over a width encloses more light than a sharp one, so it is moved inwards.
    float inset = apertureCurvature(aperture) * width * width / (24.0f * abs(confusion));
    float inside = insideDisc(aperture, from, confusion) - inset;
    float coverage = inside > 0.0f ? 1.0f : 0.0f;
    if (abs(inside) < 0.5f * width + 0.5f) {
        coverage = 0.0f;
        for (uint i = 0u; i < 4u; ++i) {
            vec2 place = from + 0.5f * vec2(i & 1u, i >> 1u) - 0.25f;
            float at = insideDisc(aperture, place, confusion) - inset;
            coverage += 0.25f * clamp(at / width + 0.5f, 0.0f, 1.0f);
        }
    }
    return coverage / (area * confusion * confusion);
}

SHUTTER_SHADER_END

#endif
