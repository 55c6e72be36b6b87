// SPDX-License-Identifier: MIT
// When light is taken: shutter times whose density is the shutter's response, from numbers that are
// uniform in [0, 1], by the inverse of its distribution. All methods place their samples by it, each
// sample then counts alike.
#ifndef SHUTTER_SHUTTER_RESPONSE_GLSL
#define SHUTTER_SHUTTER_RESPONSE_GLSL

#ifndef __cplusplus
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#endif

#include "common/shutter_response_shared.h"

SHUTTER_SHADER_BEGIN

#ifdef __cplusplus
struct ResponseRef {
    const ResponseTable& value;
};
#else
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ResponseRef {
    ResponseTable value;
};
#endif

/// The last knot but the end before which at most u of the light is taken: the first of the segment
/// in which u is reached.
/// \param first where to begin: a knot that is not behind it
SHUTTER_INLINE uint findSegment(ResponseRef response, uint first, float u) {
    while (first + 2u < response.value.knotCount &&
           response.value.knots[first + 1u].cumulative <= u)
        ++first;
    return first;
}

#ifdef __cplusplus
/// Inverts the knots once, so that no lookup has to search among them. The knots must be set.
inline void fillFirstKnots(ResponseTable& table) {
    for (uint cell = 0u; cell < kResponseCells; ++cell)
        table.firstKnots[cell] = findSegment({table}, 0u, float(cell) / float(kResponseCells));
}
#endif

/// Shutter time before which the share u of the light is taken, [0, 1]; u is clamped to [0, 1].
///
/// Between two knots the density is d + g x at x after the first, so the light since then is
/// L = d x + g x^2 / 2. Of the quadratic's roots this is the one that rises from 0, in the form that
/// neither divides by g (0: constant) nor subtracts near-equals: x = 2 L / (d + sqrt(d^2 + 2 g L)).
SHUTTER_INLINE float inverseResponse(ResponseRef response, float u) {
    uint cell = min(uint(clamp(u, 0.0f, 1.0f) * float(kResponseCells)), kResponseCells - 1u);
    uint known = min(response.value.firstKnots[cell], response.value.knotCount - 2u);
    uint first = findSegment(response, known, u);
    ResponseKnot a = response.value.knots[first];
    ResponseKnot b = response.value.knots[first + 1u];
    float light = max(u - a.cumulative, 0.0f);
    float slope = (b.density - a.density) / (b.s - a.s);
    float root = sqrt(max(a.density * a.density + 2.0f * slope * light, 0.0f));
    // Nothing is taken in a dark segment, nor yet at its start: 0 over 0.
    float x = 2.0f * light / max(a.density + root, 1.0e-20f);
    float end = b.s;
    return min(a.s + x, end);
}

/// The other way round: share of the light that is taken before s.
SHUTTER_INLINE float cumulativeResponse(ResponseRef response, float s) {
    uint last = 1u;
    while (last < response.value.knotCount - 1u && response.value.knots[last].s < s) ++last;
    ResponseKnot a = response.value.knots[last - 1u];
    ResponseKnot b = response.value.knots[last];
    float length_ = b.s - a.s;
    float x = clamp(s - a.s, 0.0f, length_);
    float slope = (b.density - a.density) / length_;
    return min(a.cumulative + x * (a.density + 0.5f * slope * x), 1.0f);
}

#ifndef __cplusplus
/// inverseResponse() of the table at an address; a box (0) leaves u as it is, bit for bit.
float respondAt(uvec2 response, float u) {
    if ((response.x | response.y) == 0u) return u;
    return inverseResponse(ResponseRef(response), u);
}
#endif

SHUTTER_SHADER_END

#endif
