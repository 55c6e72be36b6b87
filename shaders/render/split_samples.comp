// SPDX-License-Identifier: MIT
// Copies pixels whose samples are alike, and lists the others for split_edges.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "render/split_samples_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { SplitParams params; };
layout(binding = 0) uniform sampler2DMS uColorSamples;
layout(binding = 1) uniform sampler2DMS uNormalSamples;
layout(binding = 2) uniform sampler2DMS uMotionDepthSamples;
layout(binding = 3) uniform usampler2DMS uEntityIdSamples;
layout(binding = 4, rgba16f) uniform writeonly image2D uColor;
layout(binding = 5, rgba16f) uniform writeonly image2D uNormal;
layout(binding = 6, rgba32f) uniform writeonly image2D uMotionDepth;
layout(binding = 7, r32ui) uniform writeonly uimage2D uEntityId;
layout(binding = 8, scalar) buffer Arguments { uvec3 groups; } uArguments; // of split_edges.comp
layout(binding = 9, scalar) buffer Edges {
    uint count;
    uint pixels[]; // x | y << 16
} uEdges;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec3 motionDepth = texelFetch(uMotionDepthSamples, pixel, 0).xyz;
    // One triangle covers all samples, and blended surfaces, which have colours alone, cover none.
    bool isWhole = params.hasBlended == 0u;
    for (int i = 1; i < int(kSampleCount); ++i)
        isWhole = isWhole && texelFetch(uMotionDepthSamples, pixel, i).xyz == motionDepth;
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
    imageStore(uNormal, pixel, texelFetch(uNormalSamples, pixel, 0));
    imageStore(uMotionDepth, pixel, vec4(motionDepth, 0.0f));
    imageStore(uEntityId, pixel, texelFetch(uEntityIdSamples, pixel, 0));
}
