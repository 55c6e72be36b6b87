// SPDX-License-Identifier: MIT
// Resolves blocks that can see only one plane of this frame's raster: only colours are read.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/resolved.glsl"
#include "motion_blur/resolved_lens.glsl"
#define SHUTTER_BLOCK_LIST_BINDING 3
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kThreadRows = kGroupSize; // of a group
layout(constant_id = 3) const bool kHasLens = false; // each instant has a place of the lens
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1, rgba16f) uniform writeonly image2D uBlurred;
layout(binding = 2, scalar) readonly buffer BlockSampleBuffer { BlockSample uBlockSamples[]; };

/// Pixels of a block, in one column, per thread: they share loaded data.
const uint kRows = kGroupSize / kThreadRows;

/// Adds the samples of all pixels of the column at the same instants.
void addShared(uint firstSample, uint count, vec2 inBlock, inout vec3 sums[kRows]) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    uint first = firstSample + (kHasLens ? 0u : middleSet(method));
    uint perSample = kHasLens ? 2u : method.setCount;
    for (uint i = 0u; i < count; ++i) {
        uint taken = takenInstant(i, count, params.sampleCount);
        BlockSample blockSample = uBlockSamples[first + taken * perSample];
        vec2 at = samplePlace(blockSample, inBlock) * pixelsToUv;
        vec2 step_ = unpackHalf2x16(blockSample.perY) * float(kThreadRows) * pixelsToUv;
        for (uint row = 0u; row < kRows; ++row)
            sums[row] += textureLod(uColor, at + step_ * float(row), 0.0f).rgb;
    }
}

/// Adds the samples of each pixel at individual instants.
void addOwn(ivec2 pixel, uint firstSample, vec2 inBlock, float noise, inout vec3 sums[kRows]) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    for (uint row = 0u; row < kRows; ++row) {
        ivec2 below = ivec2(0, row * kThreadRows);
        uint first = firstSample + findSet(method, pixel + below, noise);
        for (uint i = 0u; i < params.sampleCount; ++i) {
            vec2 at = samplePlace(uBlockSamples[first + i * method.setCount], inBlock + vec2(below));
            sums[row] += textureLod(uColor, at * pixelsToUv, 0.0f).rgb;
        }
    }
}

/// The same with a lens, by whose sets they differ: every fourth row has the same.
void addThroughLens(ivec2 pixel, uint firstSample, vec2 inBlock, inout vec3 sums[kRows]) {
    const uint kTurns = kRows < 4u ? kRows : 4u;
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    for (uint i = 0u; i < params.sampleCount; ++i) {
        BlockSample blockSample = uBlockSamples[firstSample + 2u * i];
        BlockSample change = uBlockSamples[firstSample + 2u * i + 1u];
        vec2 at = samplePlace(blockSample, inBlock);
        vec2 step_ = unpackHalf2x16(blockSample.perY) * float(kThreadRows);
        for (uint turn = 0u; turn < kTurns; ++turn) {
            uint set = lensSetOf(uvec2(pixel + ivec2(0, turn * kThreadRows)));
            vec2 below = vec2(0.0f, float(turn * kThreadRows));
            SetStep own = stepOfSet(motions, blockSample, change, i, set, inBlock + below);
            vec2 first = at + own.step_ + step_ * float(turn);
            vec2 perTurns = (step_ + own.perY * float(kThreadRows)) * float(kTurns);
            for (uint row = turn; row < kRows; row += kTurns)
                sums[row] += textureLod(
                    uColor, (first + perTurns * float(row / kTurns)) * pixelsToUv, 0.0f
                ).rgb;
        }
    }
}

void main() {
    uvec2 block;
    if (!findBlock(params.sizePx, block)) return;
    ivec2 pixel = ivec2(block * kGroupSize + gl_LocalInvocationID.xy);
    uvec2 blocks = (params.sizePx + kGroupSize - 1u) / kGroupSize;
    uint firstSample = (block.y * blocks.x + block.x) * looksPerBlock(method);
    uint count = uBlockSamples[firstSample].perX;
    float noise = uintBitsToFloat(uBlockSamples[firstSample].perY);
    vec2 inBlock = vec2(gl_LocalInvocationID.xy) + 0.5f - 0.5f * float(kGroupSize);
    vec3 sums[kRows];
    for (uint row = 0u; row < kRows; ++row) sums[row] = vec3(0.0f);
    if (kHasLens && noise > 0.0f)
        addThroughLens(pixel, firstSample + 1u, inBlock, sums);
    else if (noise > 0.0f)
        addOwn(pixel, firstSample + 1u, inBlock, noise, sums);
    else
        addShared(firstSample + 1u, count, inBlock, sums);
    float alpha = 1.0f;
    if (kHasLens && noise > 0.0f) alpha = alphaForFilter(method, uBlockSamples[firstSample].place.x);
    for (uint row = 0u; row < kRows; ++row) {
        ivec2 to = pixel + ivec2(0, row * kThreadRows);
        if (all(lessThan(uvec2(to), params.sizePx)))
            imageStore(uBlurred, to, vec4(sums[row] / float(count), alpha));
    }
}
