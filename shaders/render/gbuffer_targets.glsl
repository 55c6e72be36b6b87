// SPDX-License-Identifier: MIT
// What a fragment leaves in the G-buffer. With SHUTTER_SEVERAL_SAMPLES: what it leaves for
// split_samples.comp, in fewer and narrower images, since each sample is written by itself; with
// SHUTTER_MASKS_SAMPLES, which goes with it, alpha is tested at each. Normals only with
// SHUTTER_WRITES_NORMALS.
#ifndef SHUTTER_GBUFFER_TARGETS_GLSL
#define SHUTTER_GBUFFER_TARGETS_GLSL

#include "render/scene_shared.h"

layout(location = 0) out vec4 outColor;
#ifdef SHUTTER_SEVERAL_SAMPLES

#include "render/split_samples_shared.h"

layout(location = 1) out uvec4 outSurface; // bits of motion and depth, and the entity's word
#ifdef SHUTTER_WRITES_NORMALS
layout(location = 2) out uint outNormal;   // packNormal()
#endif

/// Differs, as a rule, between triangles of one entity that cover a pixel together.
uint mixBits(vec2 motion, float depth) {
    uvec3 bits = floatBitsToUint(vec3(motion, depth));
    return (bits.x * 3u + bits.y * 5u + bits.z) * 0x9E3779B1u;
}

void writeTargets(vec4 color, vec3 normal, vec2 motion, float depth, uint row) {
    outColor = color;
    uint word = row;
    if (row != kNoEntity) {
#ifdef SHUTTER_MASKS_SAMPLES
        int covered = gl_SampleMask[0];
#else
        int covered = gl_SampleMaskIn[0];
#endif
        bool coversAll = covered == int((1u << kSampleCount) - 1u);
        word |= mixBits(motion, depth) >> 25 << kSampleRowBits;
        word |= coversAll ? 0u : kSampleOfPart;
    }
    outSurface = uvec4(floatBitsToUint(vec3(motion, depth)), word);
#ifdef SHUTTER_WRITES_NORMALS
    outNormal = row != kNoEntity ? packNormal(normal) : 0u;
#endif
}

#else

layout(location = 1) out vec4 outMotionDepth;
layout(location = 2) out uint outEntityId;
#ifdef SHUTTER_WRITES_NORMALS
layout(location = 3) out vec4 outNormal;
#endif

void writeTargets(vec4 color, vec3 normal, vec2 motion, float depth, uint row) {
    outColor = color;
    outMotionDepth = vec4(motion, depth, 0.0f);
    outEntityId = row;
#ifdef SHUTTER_WRITES_NORMALS
    outNormal = vec4(normal, 0.0f);
#endif
}

#endif

#endif
