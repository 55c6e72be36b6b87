// SPDX-License-Identifier: MIT
// The sensor's sensitivity over the exposure, piecewise linear, as shaders read it.
#ifndef SHUTTER_SHUTTER_RESPONSE_SHARED_H
#define SHUTTER_SHUTTER_RESPONSE_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kMaxResponseKnots = 64u;
/// Equal shares of the light, each with the knot at which a lookup begins: twice the number of
/// knots, so that a lookup skips less than half a knot on average for any distribution of knots. A
/// power of two.
SHUTTER_CONST uint kResponseCells = 128u;

struct ResponseKnot {
    float s;          // shutter time, [0, 1], rising from knot to knot
    float density;    // sensitivity there over its mean, 0 or more; linear to the next knot
    float cumulative; // share of the light that is taken before s, [0, 1]
    float padding0;
};

/// Accessed by address; address 0 is a box, which needs no table.
struct ResponseTable {
    uint knotCount; // 2 to kMaxResponseKnots; the first at s 0, the last at 1
    uint padding0;
    uint padding1;
    uint padding2;
    ResponseKnot knots[kMaxResponseKnots];
    /// The last knot but the end before which at most cell / kResponseCells of the light is taken
    /// (fillFirstKnots()). One before it is right as well and costs time: all 0 will do.
    uint firstKnots[kResponseCells];
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::ResponseKnot) == 16);
static_assert(sizeof(shutter::shader::ResponseTable) == 1552);
#endif

#endif
