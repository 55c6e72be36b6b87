// SPDX-License-Identifier: MIT
// Totals of a host's entity ids, and samples of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/check_grid.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    PrepareArea area;
    uint noneValue;
    uint rowCount; // 0: unknown
} params;
layout(binding = 0) uniform usampler2D uIds;
layout(binding = 1, scalar) buffer Totals { CheckTotals totals; };

uint readId(uvec2 pixel) {
    vec2 place = vec2(pixel) + 0.5f;
    return textureLod(uIds, params.area.origin + place * params.area.perPixel, 0.0f).x;
}

shared uint sNone;
shared uint sBeyond;

void main() {
    uint thread = gl_LocalInvocationIndex;
    if (thread == 0u) {
        sNone = 0u;
        sBeyond = 0u;
    }
    barrier();
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (all(lessThan(pixel, params.sizePx))) {
        uint id = readId(pixel);
        if (id == params.noneValue) {
            atomicAdd(sNone, 1u);
        } else if (params.rowCount != 0u && id >= params.rowCount) {
            atomicAdd(sBeyond, 1u);
        } else if (id < kCheckRows) {
            // Nearly all pixels find their row's bit set.
            uint bit = 1u << (id & 31u);
            if ((totals.seenRows[id >> 5u] & bit) == 0u) atomicOr(totals.seenRows[id >> 5u], bit);
        }
    }
    barrier();
    if (thread == 0u && sNone != 0u) atomicAdd(totals.counts[kCheckIdNone], sNone);
    if (thread == 0u && sBeyond != 0u) atomicAdd(totals.counts[kCheckIdBeyond], sBeyond);
    // A sample for each of the first threads of the picture.
    uvec2 count = gl_NumWorkGroups.xy * kGroupSize;
    uint threads = count.x * count.y;
    uint first = pixel.y * count.x + pixel.x;
    for (uint at = first; at < kCheckSamples; at += threads)
        totals.samples[at].id =
            readId(checkedPixel(uvec2(at % kCheckAcross, at / kCheckAcross), params.sizePx));
    uvec2 fine = fineGrid(params.sizePx);
    for (uint at = first; at < fine.x * fine.y; at += threads)
        totals.fineIds[at] = readId(finePixel(uvec2(at % fine.x, at / fine.x), params.sizePx));
}
