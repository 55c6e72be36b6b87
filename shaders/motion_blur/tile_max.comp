// SPDX-License-Identifier: MIT
// Longest motion in each tile, clamped to the tile's size; how far the others are from it; the range
// of depths. A group per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/block_class.glsl"
#include "motion_blur/weights.glsl"

// Threads of a group: few where a group is a loop over threads (software devices), so that little is
// left to add up.
layout(local_size_x_id = 0, local_size_y = 1) in;
layout(constant_id = 1) const uint kThreads = kTileColumns;

layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1, rg32f) uniform writeonly image2D uTiles;
layout(binding = 2, rgba32f) uniform writeonly image2D uRanges;

struct Ranges {
    vec2 longest;
    vec2 least;
    vec2 greatest;
    vec2 depth; // nearest, farthest
};

shared Ranges sRanges[kThreads];

Ranges ranges = Ranges(vec2(0.0f), vec2(3.0e38f), vec2(-3.0e38f), vec2(3.0e38f, -3.0e38f));
float longestSquare = 0.0f;

void take(vec2 uv) {
    vec3 texel = textureLod(uMotionDepth, uv, 0.0f).xyz;
    vec2 motion = shownMotion(texel.xy, texel.z, params.maxMotionDepth);
    float square = dot(motion, motion);
    bool longer = isLonger(motion, square, ranges.longest, longestSquare);
    ranges.longest = longer ? motion : ranges.longest;
    longestSquare = longer ? square : longestSquare;
    ranges.least = min(ranges.least, motion);
    ranges.greatest = max(ranges.greatest, motion);
    ranges.depth = vec2(min(ranges.depth.x, texel.z), max(ranges.depth.y, texel.z));
}

/// Takes over what another thread has found.
void take(Ranges other) {
    ranges.longest = longerMotion(ranges.longest, other.longest);
    ranges.least = min(ranges.least, other.least);
    ranges.greatest = max(ranges.greatest, other.greatest);
    ranges.depth = vec2(min(ranges.depth.x, other.depth.x), max(ranges.depth.y, other.depth.y));
}

const uint kRows = kThreads / kTileColumns;
const uint kUnrolled = 4u; // rows that a thread takes in one go

void main() {
    uvec2 tile = gl_WorkGroupID.xy;
    uvec2 first = tile * params.tileSizePx;
    uvec2 last = min(first + params.tileSizePx, params.sizePx) - 1u; // it may be partial
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    // Threads walk the tile in rows of kTileColumns: no division by the tile's width. All take the
    // same steps; beyond the tile's end its last pixels come again, which changes nothing.
    uint column = gl_LocalInvocationIndex % kTileColumns;
    uint row = gl_LocalInvocationIndex / kTileColumns;
    vec2 lastCentre = vec2(last) + 0.5f;
    for (uint x = first.x; x <= last.x; x += kTileColumns) {
        float centreX = min(float(x + column) + 0.5f, lastCentre.x) * pixelsToUv.x;
        for (uint y = first.y; y <= last.y; y += kRows * kUnrolled) {
            float centreY = float(y + row) + 0.5f;
            take(vec2(centreX, min(centreY, lastCentre.y) * pixelsToUv.y));
            take(vec2(centreX, min(centreY + float(kRows), lastCentre.y) * pixelsToUv.y));
            take(vec2(centreX, min(centreY + float(2u * kRows), lastCentre.y) * pixelsToUv.y));
            take(vec2(centreX, min(centreY + float(3u * kRows), lastCentre.y) * pixelsToUv.y));
        }
    }
    uint thread = gl_LocalInvocationIndex;
    sRanges[thread] = ranges;
    barrier();
    if (kRows > 1u) {
        // First down each column, then across: no thread has to take over all.
        if (thread < kTileColumns) {
            for (uint i = thread + kTileColumns; i < kThreads; i += kTileColumns) take(sRanges[i]);
            sRanges[thread] = ranges;
        }
        barrier();
    }
    if (thread != 0u) return;
    for (uint i = 1u; i < kTileColumns; ++i) take(sRanges[i]);
    float limit = float(params.tileSizePx);
    float spread = tileSpread(ranges.least, ranges.greatest, length(ranges.longest), limit);
    imageStore(uTiles, ivec2(tile), vec4(clampMotion(ranges.longest, limit), 0.0f, 0.0f));
    imageStore(uRanges, ivec2(tile), vec4(spread, ranges.depth, 0.0f));
}
