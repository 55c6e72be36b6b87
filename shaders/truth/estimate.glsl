// SPDX-License-Identifier: MIT
// Mean and standard error from two independent sets of rays.
//
// A stratified set converges faster than the spread of its own samples suggests, so no formula over
// one set gives its error. Two sets A and B that share no random number do: with means a and b of n
// rays each, the picture shows (a + b) / 2, whose variance is that of a over 2, and E[(a - b)^2] is
// twice the variance of a: so ((a - b) / 2)^2 is that variance, without bias. One pixel's value is
// unreliable; its root mean square over a picture is accurate to a few percent.
#ifndef SHUTTER_ESTIMATE_GLSL
#define SHUTTER_ESTIMATE_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Which set ray `index` belongs to; index / 2 is its place there.
SHUTTER_INLINE uint setOfRay(uint index) { return index & 1u; }

/// Rays of set 0 or 1 among the first `count`.
SHUTTER_INLINE uint raysOfSet(uint count, uint set_) { return (count + 1u - set_) >> 1u; }

/// \param count rays of both, above 0
SHUTTER_INLINE vec3 meanOfSets(vec3 sumA, vec3 sumB, uint count) {
    return (sumA + sumB) * (1.0f / float(count));
}

/// Per channel; its square is an unbiased variance of the mean for even counts. 0 below two rays.
SHUTTER_INLINE vec3 errorOfSets(vec3 sumA, vec3 sumB, uint count) {
    if (count < 2u) return vec3(0.0f);
    vec3 a = sumA * (1.0f / float(raysOfSet(count, 0u)));
    vec3 b = sumB * (1.0f / float(raysOfSet(count, 1u)));
    return abs(a - b) * 0.5f;
}

SHUTTER_SHADER_END

#endif
