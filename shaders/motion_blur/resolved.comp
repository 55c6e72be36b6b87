// SPDX-License-Identifier: MIT
// Looks up each pixel's sample at each instant of the exposure, in this frame's raster or else in
// the last frame's.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved_shared.h"
#include "motion_blur/motion_blur_shared.h"

layout(constant_id = 1) const bool kFindsEdges = false; // pixels are listed for rays

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};

#include "motion_blur/resolved_hidden.glsl"
#include "motion_blur/resolved_lens_color.glsl"

#define SHUTTER_BLOCK_LIST_BINDING 23
#include "motion_blur/block_list.glsl"

layout(binding = 24, scalar) buffer ListedPixels { uvec2 uListed[]; };
layout(binding = 25, scalar) buffer ListArguments { DispatchArguments uListArguments; };

/// For the pass that traces: the pixel and which classes its samples have.
void listPixel(ivec2 pixel, uint counts[kSampleClasses]) {
    uint classes = 0u;
    for (uint i = 0u; i < kSampleClasses; ++i) {
        if (counts[i] == 0u) continue;
        classes |= 1u << i;
        atomicAdd(uCounters.classes[i], counts[i]);
    }
    uint index = atomicAdd(uCounters.listedPixels, 1u);
    uListed[index] = uvec2(uint(pixel.x) | uint(pixel.y) << 16, classes);
    uint group = index / kRevealThreads;
    atomicMax(uListArguments.groupsX, min(group + 1u, kListRow));
    if (index % (kRevealThreads * kListRow) == 0u) atomicAdd(uListArguments.groupsY, 1u);
}

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    PixelSearch search = beginSearch(pixel);
    Guesses guesses = beginGuesses(search);
    uint counts[kSampleClasses];
    for (uint i = 0u; i < kSampleClasses; ++i) counts[i] = 0u;
    vec3 sum = vec3(0.0f);
    uint found = 0u;
    uint guessed = 0u;
    uint fromSecond = 0u;
    uint fromLast = 0u;
    float confusionPx = kFarthest; // the least
    uint searched = params.sampleCount;
    // Rays may go to any of them, and an edge takes several also where the motion is short.
    if (!kFindsEdges && params.uniformMotionPx > 0.0f && !search.isAtEdge)
        searched = uBlockSamples[search.firstSample - 1u].perX;
    for (uint i = 0u; i < searched; ++i) {
        uint taken = takenInstant(i, searched, params.sampleCount);
        uint instant = taken * method.setCount + search.set;
        Doubt doubt = kNoDoubt;
        Seen seen = searchInstant(search, i, instant, guesses, doubt);
        vec3 color = vec3(0.0f);
        if (seen.isFound) {
            if (kHasLens) confusionPx = min(confusionPx, confusionOf(seen));
            color = colorThroughLens(seen, search, instant);
            fromSecond += seen.layer == kSecondLayer ? 1u : 0u;
            fromLast += seen.layer == kLastLayer ? 1u : 0u;
            ++found;
        } else {
            Substitute substitute = findSubstitute(search, instant);
            if (substitute.distancePx < kFarthest) {
                color = substitute.color;
                ++guessed;
            }
        }
        sum += color;
        if (kFindsEdges) ++counts[classify(seen, color, doubt)];
    }
    if (fromSecond > 0u) atomicAdd(uCounters.fromSecond, fromSecond);
    if (fromLast > 0u) atomicAdd(uCounters.fromLast, fromLast);
    if (found < searched) atomicAdd(uCounters.unresolved, searched - found);
    // Unknown samples get the mean of the pixel's known samples.
    uint known = found + guessed;
    vec3 color = known > 0u ? sum / float(known) : fetchColor(kRasterLayer, pixel);
    float alpha = 1.0f;
    if (kHasLens && found > 0u && search.hasOwnSet) alpha = alphaForFilter(method, confusionPx);
    imageStore(uBlurred, pixel, vec4(color, alpha));
    if (kFindsEdges) listPixel(pixel, counts);
}
