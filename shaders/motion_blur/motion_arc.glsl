// SPDX-License-Identifier: MIT
// The path of a surface that turns, from how its motion differs between neighbouring pixels. Motion over
// the exposure is a displacement along a chord. Where it is J times the place relative to a fixed point,
// with a J whose eigenvalues are complex, points go round that fixed point on ellipses.
#ifndef SHUTTER_MOTION_BLUR_MOTION_ARC_GLSL
#define SHUTTER_MOTION_BLUR_MOTION_ARC_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

// All functions of one matrix J = t + K, where t is a number and K has no trace, are x + y K, and K K is
// the number q < 0: they multiply like complex numbers. A vec2 is such an x and y.

SHUTTER_INLINE vec2 multiplyTurns(vec2 a, vec2 b, float q) {
    return vec2(a.x * b.x + q * a.y * b.y, a.x * b.y + a.y * b.x);
}

SHUTTER_INLINE vec2 divideTurns(vec2 a, vec2 b, float q) {
    float norm = b.x * b.x - q * b.y * b.y;
    return multiplyTurns(a, vec2(b.x, -b.y), q) / norm;
}

/// (e^a - 1) / a, by its series: to 2e-4 where |a| is 1.
SHUTTER_INLINE vec2 meanOfTurn(vec2 a, float q) {
    vec2 sum = vec2(1.0f, 0.0f);
    for (float k = 6.0f; k > 1.5f; k -= 1.0f)
        sum = vec2(1.0f, 0.0f) + multiplyTurns(a, sum, q) / k;
    return sum;
}

SHUTTER_CONST int kArcPowers = 6;

/// A path, as a polynomial.
struct Arc {
    vec2 power[kArcPowers]; // pixels per u, u^2, ...
};

/// Where the raster has what is at the pixel at u (taps.glsl), relative to the pixel.
SHUTTER_INLINE vec2 placeOnArc(Arc arc, float u) {
    vec2 sum = arc.power[kArcPowers - 1];
    for (int i = kArcPowers - 2; i >= 0; --i) sum = arc.power[i] + u * sum;
    return u * sum;
}

/// \param dx, dy change of the motion from one pixel to the next in a row, in a column
SHUTTER_INLINE Arc makeArc(vec2 motion, vec2 dx, vec2 dy, float rasterTime) {
    Arc arc;
    arc.power[0] = motion;
    for (int i = 1; i < kArcPowers; ++i) arc.power[i] = vec2(0.0f);
    float t = 0.5f * (dx.x + dy.y);
    vec3 k = vec3(0.5f * (dx.x - dy.y), dx.y, dy.x); // K = (x z; y -x)
    float q = k.x * k.x + k.y * k.z;
    // A shear, such as that of a floor that a camera passes, is no turn, though half of it looks like one.
    float size = k.x * k.x + 0.5f * (k.y * k.y + k.z * k.z);
    // A turn of less than 3 degrees bends no path by more than a pixel in 150. Beyond 70 the chord says
    // little of the turn, and at 180 nothing.
    bool turns = -q > 0.3f * size && -q > 0.0025f && t * t - q < 1.44f;
    if (!turns) return arc;
    vec2 one = vec2(1.0f, 0.0f);
    vec2 chord = vec2(t, 1.0f);
    vec2 turn = chord;
    vec2 ratio = one; // chord / turn
    float before = rasterTime;
    float after = 1.0f - rasterTime;
    // The chord is e^(after turn) - e^(-before turn): solved for the turn by Newton's method.
    for (int i = 0; i < 4; ++i) {
        vec2 later = after * meanOfTurn(turn * after, q);
        vec2 earlier = before * meanOfTurn(turn * -before, q);
        ratio = later + earlier;
        vec2 error = multiplyTurns(turn, ratio, q) - chord;
        vec2 slope = after * (one + multiplyTurns(turn, later, q)) +
                     before * (one - multiplyTurns(turn, earlier, q));
        turn -= divideTurns(error, slope, q);
    }
    // (e^(turn u) - 1) / turn, by its series, of the motion over a chord.
    vec2 turnedMotion = vec2(k.x * motion.x + k.z * motion.y, k.y * motion.x - k.x * motion.y);
    vec2 term = divideTurns(one, ratio, q);
    for (int i = 0; i < kArcPowers; ++i) {
        arc.power[i] = motion * term.x + turnedMotion * term.y;
        term = multiplyTurns(term, turn, q) / float(i + 2);
    }
    return arc;
}

SHUTTER_SHADER_END

#endif
