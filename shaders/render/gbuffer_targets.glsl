// SPDX-License-Identifier: MIT
// What a fragment leaves in the G-buffer. With SHUTTER_SEVERAL_SAMPLES: what it leaves for
// split_samples.comp, in fewer and narrower images, since each sample is written by itself.
#ifndef SHUTTER_GBUFFER_TARGETS_GLSL
#define SHUTTER_GBUFFER_TARGETS_GLSL

#include "render/scene_shared.h"

layout(location = 0) out vec4 outColor;
#ifdef SHUTTER_SEVERAL_SAMPLES

#include "render/split_samples_shared.h"

layout(location = 1) out uvec4 outSurface; // bits of motion and depth, and the entity's word
layout(location = 2) out uint outNormal;   // packNormal()

/// Differs, as a rule, between triangles of one entity that cover a pixel together.
uint mixBits(vec2 motion, float depth) {
    uvec3 bits = floatBitsToUint(vec3(motion, depth));
    return (bits.x * 3u + bits.y * 5u + bits.z) * 0x9E3779B1u;
}

void writeTargets(vec4 color, vec3 normal, vec2 motion, float depth, uint row) {
    outColor = color;
    outNormal = 0u;
    uint word = row;
    if (row != kNoEntity) {
        outNormal = packNormal(normal);
        bool coversAll = gl_SampleMaskIn[0] == int((1u << kSampleCount) - 1u);
        word |= mixBits(motion, depth) >> 25 << kSampleRowBits;
        word |= coversAll ? 0u : kSampleOfPart;
    }
    outSurface = uvec4(floatBitsToUint(vec3(motion, depth)), word);
}

#else

layout(location = 1) out vec4 outNormal;
layout(location = 2) out vec4 outMotionDepth;
layout(location = 3) out uint outEntityId;

void writeTargets(vec4 color, vec3 normal, vec2 motion, float depth, uint row) {
    outColor = color;
    outNormal = vec4(normal, 0.0f);
    outMotionDepth = vec4(motion, depth, 0.0f);
    outEntityId = row;
}

#endif

#endif
