// SPDX-License-Identifier: MIT
// A raster with several samples per pixel, as both shaders that split it read it, and what they write.
#ifndef SHUTTER_SPLIT_SAMPLES_GLSL
#define SHUTTER_SPLIT_SAMPLES_GLSL

#include "render/split_samples_shared.h"

layout(push_constant, scalar) uniform Push { SplitParams params; };
layout(binding = 0) uniform sampler2DMS uColorSamples;
layout(binding = 1) uniform usampler2DMS uSurfaceSamples;
layout(binding = 2) uniform usampler2DMS uNormalSamples; // with params.hasNormals
layout(binding = 3, rgba16f) uniform writeonly image2D uColor;
layout(binding = 4, rgba16f) uniform writeonly image2D uNormal; // likewise
layout(binding = 5, rgba32f) uniform writeonly image2D uMotionDepth;
layout(binding = 6, r32ui) uniform writeonly uimage2D uEntityId;

/// Makes a sample the pixel's own surface.
/// \param surface of that sample
/// \param covers GBuffer::motionDepth's fourth
void storeSurface(ivec2 pixel, int index, uvec4 surface, uint covers) {
    uint row = rowOfSample(surface.w);
    imageStore(uMotionDepth, pixel, vec4(uintBitsToFloat(surface.xyz), float(covers)));
    imageStore(uEntityId, pixel, uvec4(row, 0u, 0u, 0u));
    if (params.hasNormals == 0u) return;
    vec3 normal = vec3(0.0f);
    if (row != kNoEntity) normal = unpackNormal(texelFetch(uNormalSamples, pixel, index).x);
    imageStore(uNormal, pixel, vec4(normal, 0.0f));
}

#endif
