// SPDX-License-Identifier: MIT
// Copies pixels whose samples are alike, and lists the others for split_edges.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "render/split_samples.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 7, scalar) buffer Arguments { uvec3 groups; } uArguments; // of split_edges.comp
layout(binding = 8, scalar) buffer Edges {
    uint count;
    uint pixels[]; // x | y << 16
} uEdges;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    // One triangle covers all samples, and blended surfaces, which have colours alone, cover none.
    uvec4 surface = texelFetch(uSurfaceSamples, pixel, 0);
    uint word = surface.w;
    bool isWhole = params.hasBlended == 0u && (word < kSampleOfPart || word == kNoEntity);
    for (int i = 1; i < int(kSampleCount); ++i)
        isWhole = isWhole && texelFetch(uSurfaceSamples, pixel, i).w == word;
    if (!isWhole) {
        uint index = atomicAdd(uEdges.count, 1u);
        uEdges.pixels[index] = uint(pixel.x) | uint(pixel.y) << 16;
        if (index % kSplitGroupSize == 0u) {
            uint group = index / kSplitGroupSize;
            if (group < kSplitRow) atomicAdd(uArguments.groups.x, 1u);
            if (group % kSplitRow == 0u) atomicAdd(uArguments.groups.y, 1u);
        }
        return;
    }
    imageStore(uColor, pixel, texelFetch(uColorSamples, pixel, 0));
    storeSurface(pixel, 0, surface, 0u);
}
