// SPDX-License-Identifier: MIT
// Totals of a host's colour, motion vectors and depth, and samples of the latter two.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/numeric.glsl"
#include "motion_blur/check_grid.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    PrepareArea color;
    PrepareArea vectors;
    PrepareArea depth;
    vec2 pixelsPerUnit;
    float skyValue;
    uint flags;
    uint serial;
} params;
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uVectors;
layout(binding = 2) uniform sampler2D uDepth;
layout(binding = 3, scalar) buffer Totals { CheckTotals totals; };

shared uint sCounts[kCheckCounts];
shared uint sLeast;
shared uint sMost;

void countIf(uint index, bool counts) {
    if (counts) atomicAdd(sCounts[index], 1u);
}

bool isInfinite(float x) { return (floatBitsToUint(x) & 0x7FFFFFFFu) == 0x7F800000u; }

bool isNegative(float x) { return x < 0.0f && !isNotANumber(x); }

void countColor(vec3 color) {
    countIf(kCheckColorNan, isNotANumber(color.x) || isNotANumber(color.y) || isNotANumber(color.z));
    countIf(kCheckColorInfinite, isInfinite(color.x) || isInfinite(color.y) || isInfinite(color.z));
    countIf(kCheckColorNegative, isNegative(color.x) || isNegative(color.y) || isNegative(color.z));
}

void countMotion(vec2 vector) {
    countIf(kCheckMotionNan, isNotANumber(vector.x) || isNotANumber(vector.y));
    countIf(kCheckMotionInfinite, isInfinite(vector.x) || isInfinite(vector.y));
    bool isKnown = isFinite(vector.x) && isFinite(vector.y);
    float speed = length(vector * params.pixelsPerUnit);
    countIf(kCheckMotionBeyond, isKnown && !(speed <= length(vec2(params.sizePx))));
}

void countDepth(float depth) {
    countIf(kCheckDepthNan, isNotANumber(depth));
    countIf(kCheckDepthInfinite, isInfinite(depth));
    if (!isFinite(depth)) return;
    countIf(kCheckDepthNegative, depth < 0.0f);
    countIf(kCheckDepthZero, depth == 0.0f);
    countIf(kCheckDepthOne, depth == 1.0f);
    countIf(kCheckDepthAboveOne, depth > 1.0f);
    bool isBeyond = (params.flags & kCheckSkyIsBeyond) != 0u && depth > params.skyValue;
    countIf(kCheckDepthSky, depth == params.skyValue || isBeyond);
    if (depth < 0.0f) return;
    // The bits of such floats are in the order of their values.
    uint bits = depth == 0.0f ? 0u : floatBitsToUint(depth);
    atomicMin(sLeast, bits);
    atomicMax(sMost, bits);
}

vec2 readVector(vec2 place) {
    if ((params.flags & kCheckHasVectors) == 0u) return vec2(0.0f);
    vec2 at = params.vectors.origin + place * params.vectors.perPixel;
    return textureLod(uVectors, at, 0.0f).xy;
}

float readDepth(vec2 place) {
    vec4 texel = textureLod(uDepth, params.depth.origin + place * params.depth.perPixel, 0.0f);
    return (params.flags & kCheckDepthIsThird) != 0u ? texel.z : texel.x;
}

void main() {
    uint thread = gl_LocalInvocationIndex;
    if (thread < kCheckCounts) sCounts[thread] = 0u;
    if (thread == 0u) {
        sLeast = 0xFFFFFFFFu;
        sMost = 0u;
    }
    barrier();
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (all(lessThan(pixel, params.sizePx))) {
        vec2 place = vec2(pixel) + 0.5f;
        countColor(textureLod(uColor, params.color.origin + place * params.color.perPixel, 0.0f).rgb);
        countMotion(readVector(place));
        countDepth(readDepth(place));
        if (pixel == uvec2(0u)) totals.serial = params.serial;
    }
    barrier();
    if (thread < kCheckCounts && sCounts[thread] != 0u)
        atomicAdd(totals.counts[thread], sCounts[thread]);
    if (thread == 0u) {
        atomicMin(totals.depthLeast, sLeast);
        atomicMax(totals.depthMost, sMost);
    }
    // A sample for each of the first threads of the picture.
    uvec2 count = gl_NumWorkGroups.xy * kGroupSize;
    uint threads = count.x * count.y;
    uint first = pixel.y * count.x + pixel.x;
    for (uint at = first; at < kCheckSamples; at += threads) {
        uvec2 cell = uvec2(at % kCheckAcross, at / kCheckAcross);
        vec2 place = vec2(checkedPixel(cell, params.sizePx)) + 0.5f;
        totals.samples[at].vector = readVector(place);
        totals.samples[at].depth = readDepth(place);
    }
    uvec2 fine = fineGrid(params.sizePx);
    for (uint at = first; at < fine.x * fine.y; at += threads) {
        uvec2 cell = uvec2(at % fine.x, at / fine.x);
        totals.fineDepths[at] = readDepth(vec2(finePixel(cell, params.sizePx)) + 0.5f);
    }
}
