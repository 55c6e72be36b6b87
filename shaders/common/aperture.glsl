// SPDX-License-Identifier: MIT
// Points spread evenly over the opening of a lens: the concentric map of a square onto a disc (Shirley
// and Chiu 1997), whose sectors become those of a polygon with straight or rounded sides.
#ifndef SHUTTER_APERTURE_GLSL
#define SHUTTER_APERTURE_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST float kApertureHalfTurn = 3.14159265f;

/// Opening of a lens, whose half height is 1; scene::CameraLens documents the fields.
struct Aperture {
    uint blades; // 0: a disc
    float rotation;
    float roundness;
    float squeeze;
};

/// Angle from a blade's middle, radians, within half a blade of it, left of which lies the share
/// `share` of its area. The area up to an angle a grows as (1 - roundness) cos^2(half) tan(a) +
/// roundness a.
/// \param half_ a blade's angle
SHUTTER_INLINE float bladeAngle(float share, float half_, float roundness) {
    float straight = (1.0f - roundness) * cos(half_) * cos(half_);
    float area = (2.0f * share - 1.0f) * (straight * tan(half_) + roundness * half_);
    float angle = atan(area / (straight + roundness));
    for (int i = 0; i < 4; ++i) { // Newton; the first guess is exact without roundness
        float excess = straight * tan(angle) + roundness * angle - area;
        float slope = straight / (cos(angle) * cos(angle)) + roundness;
        angle = clamp(angle - excess / slope, -half_, half_);
    }
    return angle;
}

/// x: distance of the opening's border from its middle, before it is squeezed; y: share of a step along
/// the radius that leads straight towards the border.
/// \param angle from the right, counterclockwise, radians
SHUTTER_INLINE vec2 apertureBorder(Aperture aperture, float angle) {
    if (aperture.blades == 0u || aperture.roundness >= 1.0f) return vec2(1.0f);
    float half_ = kApertureHalfTurn / float(aperture.blades);
    float turns = (angle - aperture.rotation) / (2.0f * half_);
    float inBlade = (turns - floor(turns)) * 2.0f * half_ - half_;
    float side = cos(half_) / cos(inBlade);
    return vec2(
        sqrt(mix(side * side, 1.0f, aperture.roundness)), mix(cos(inBlade), 1.0f, aperture.roundness)
    );
}

/// Area of the opening.
SHUTTER_INLINE float apertureArea(Aperture aperture) {
    if (aperture.blades == 0u || aperture.roundness >= 1.0f)
        return kApertureHalfTurn * aperture.squeeze;
    float half_ = kApertureHalfTurn / float(aperture.blades);
    float straight = (1.0f - aperture.roundness) * cos(half_) * sin(half_);
    return float(aperture.blades) * (straight + aperture.roundness * half_) * aperture.squeeze;
}

/// Length of the opening's border divided by twice its area: for a disc 1 / radius, for a polygon 1 /
/// distance of its sides from the middle; an estimate if it is rounded or squeezed.
SHUTTER_INLINE float apertureCurvature(Aperture aperture) {
    float sides = 1.0f;
    if (aperture.blades > 0u)
        sides = mix(1.0f / cos(kApertureHalfTurn / float(aperture.blades)), 1.0f, aperture.roundness);
    return sides * sqrt(0.5f + 0.5f / (aperture.squeeze * aperture.squeeze));
}

/// Where a place of the unit square, [0, 1)^2, lies in the opening: right and up. Equal areas of the
/// square become equal areas of the opening.
SHUTTER_INLINE vec2 aperturePoint(Aperture aperture, vec2 place) {
    vec2 square = place * 2.0f - 1.0f;
    if (square.x == 0.0f && square.y == 0.0f) return square;
    bool isWide = abs(square.x) > abs(square.y);
    float radius = isWide ? square.x : square.y;
    float angle = isWide ? kApertureHalfTurn * 0.25f * (square.y / square.x)
                         : kApertureHalfTurn * (0.5f - 0.25f * (square.x / square.y));
    if (aperture.blades > 0u && aperture.roundness < 1.0f) {
        float turns = angle / (2.0f * kApertureHalfTurn) + (radius < 0.0f ? 0.5f : 0.0f);
        float half_ = kApertureHalfTurn / float(aperture.blades);
        float at = (turns - floor(turns)) * float(aperture.blades);
        float inBlade = bladeAngle(at - floor(at), half_, aperture.roundness);
        float side = cos(half_) / cos(inBlade);
        radius = abs(radius) * sqrt(mix(side * side, 1.0f, aperture.roundness));
        angle = aperture.rotation + half_ * (2.0f * floor(at) + 1.0f) + inBlade;
    }
    return vec2(aperture.squeeze * radius * cos(angle), radius * sin(angle));
}

SHUTTER_SHADER_END

#endif
