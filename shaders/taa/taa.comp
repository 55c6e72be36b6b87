// SPDX-License-Identifier: MIT
// Temporal anti-aliasing of static surfaces: each frame samples another place in the pixel, and
// their mean is accumulated and preserved while something moves in front. Movers are sampled at the
// pixel's centre and pass through.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#include "render/changing_tiles.glsl"
#include "taa/taa.glsl"
#include "taa/taa_shared.h"

const uint kNoRow = 0xFFFFFFFFu;

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform Push {
    TaaParams params;
};

layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform usampler2D uEntityId;
layout(binding = 2, rgba16f) uniform writeonly image2D uPicture;
layout(binding = 3, rgba32i) uniform iimage2D uKept; // packSums(), packCounts()
layout(binding = 4, r32ui) uniform uimage2D uKeptRow;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RowTable {
    uint values[];
};

vec2 uvOf(ivec2 pixel) {
    ivec2 inside = clamp(pixel, ivec2(0), ivec2(params.sizePx) - 1);
    return (vec2(inside) + 0.5f) / vec2(params.sizePx);
}

/// Row of the entity table, or rowCount for the sky.
uint rowAt(ivec2 pixel) {
    return min(textureLod(uEntityId, uvOf(pixel), 0.0f).r, params.rows.rowCount);
}

uint stateOf(uint row) {
    return RowTable(params.rows.states).values[row];
}

/// The static ones of a pixel and those around it.
struct Neighbourhood {
    ColorMoments moments; // compressed YCoCg
    vec3 middle;          // colour at the pixel's centre, in the same encoding
};

const Neighbourhood kNowhere =
    Neighbourhood(ColorMoments(vec3(0.0f), vec3(0.0f), 0.0f), vec3(0.0f));

/// \param pixel one that shows something static
Neighbourhood lookAround(ivec2 pixel) {
    vec3 columns = findMiddleWeights(params.jitterPx.x);
    vec3 rows = findMiddleWeights(params.jitterPx.y);
    Neighbourhood around = kNowhere;
    float sum = 0.0f;
    [[dont_unroll]] for (int y = 0; y < 3; ++y)
        [[dont_unroll]] for (int x = 0; x < 3; ++x) {
            ivec2 at = pixel + ivec2(x, y) - 1;
            if (stateOf(rowAt(at)) == kMovingRow) continue;
            vec3 color = ycocgFromRgb(compress(storableColor(textureLod(uColor, uvOf(at), 0.0f).rgb)));
            around.moments = addColor(around.moments, color);
            float weight = columns[x] * rows[y];
            around.middle += weight * color;
            sum += weight;
        }
    around.middle /= sum;
    return around;
}

const Kept kNothing = Kept(ivec3(0), 0.0f, 0u, vec3(0.0f));

/// History of the pixel.
struct Before {
    Kept kept;      // count 0: nothing that is still there
    uint row;       // of this frame, or kNoRow
    bool isDoubted;
    uint stored; // what uKeptRow holds
};

Before fetchBefore(ivec2 pixel) {
    Before before = Before(kNothing, kNoRow, false, kNoRow);
    if (params.hasLast == 0u) return before;
    before.stored = imageLoad(uKeptRow, pixel).r;
    if (before.stored == kNoRow) return before;
    uint last = min(before.stored & ~kDoubted, params.rows.lastCount);
    before.row = RowTable(params.rows.nowRows).values[last];
    if (before.row == kNoRow) return before;
    ivec4 texel = imageLoad(uKept, pixel);
    before.kept = unpackKept(texel.rgb, texel.a);
    before.isDoubted = (before.stored & kDoubted) != 0u;
    return before;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec4 current = textureLod(uColor, uvOf(pixel), 0.0f);
    uint row = rowAt(pixel);
    uint state = stateOf(row);
    Before before = fetchBefore(pixel);
    bool mayDiffer = params.mayDiffer != 0u ||
                     changesOfTile(FrameRef(params.frame), vec2(pixel) + 0.5f) != 0u;
    bool isDoubted = mayDiffer || before.isDoubted;
    Kept kept = before.kept;
    vec3 color = current.rgb;
    if (state == kMovingRow) {
        row = before.row;
    } else {
        if (state == kNewRow || before.row == kNoRow) kept = kNothing;
        bool settles = countOf(kept) < float(kPlaceCount - 1u);
        Neighbourhood around = kNowhere;
        if (settles || isDoubted) around = lookAround(pixel);
        kept = addFrame(compress(storableColor(color)), kept, isDoubted, around.moments);
        vec3 mean = meanOf(kept);
        // Few samples are seen along with those around them: one alone would flicker.
        if (settles)
            mean = max(mix(mean, rgbFromYcocg(around.middle), 1.0f / countOf(kept)), vec3(0.0f));
        color = storableColor(expand(mean));
        isDoubted = mayDiffer;
    }
    imageStore(uPicture, pixel, vec4(color, current.a));
    // A settled picture writes nothing.
    if (kept != before.kept)
        imageStore(uKept, pixel, ivec4(packSums(kept), packCounts(kept)));
    uint keptRow = row == kNoRow ? kNoRow : row | (isDoubted ? kDoubted : 0u);
    if (params.hasLast == 0u || keptRow != before.stored)
        imageStore(uKeptRow, pixel, uvec4(keptRow, 0u, 0u, 0u));
}
