// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "tonemap/tonemap.glsl"
#include "tonemap/tonemap_shared.h"

/// Whether the light of the group's brightest channel is written.
layout(constant_id = 0) const bool kMeasures = false;

layout(local_size_x = kTonemapGroup, local_size_y = kTonemapGroup) in;
layout(push_constant, scalar) uniform Push { TonemapParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1, rgba8) uniform writeonly image2D uDisplay;
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer BrightestTable {
    float groups[];
};

shared uint brightest; // bits of a float that is not negative: they compare as the floats do

/// The thread's pixel counts, black for one outside the picture.
void measure(vec3 color) {
    if (gl_LocalInvocationIndex == 0u) brightest = 0u;
    barrier();
    uint bits = floatBitsToUint(max(max(max(color.x, color.y), color.z), 0.0f));
    // Few pixels are brighter than all before them, and only those need the atomic.
    if (bits > brightest) atomicMax(brightest, bits);
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    BrightestTable(params.brightest).groups[group] = uintBitsToFloat(brightest);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool isInside = all(lessThan(uvec2(pixel), params.sizePx));
    vec3 color = isInside ? texelFetch(uColor, pixel, 0).rgb : vec3(0.0f);
    if (kMeasures) measure(storableColor(color));
    if (!isInside) return;
    color *= params.gain;
    if (params.operator_ == kTonemapNeutral) color = toneMapNeutral(color);
    imageStore(uDisplay, pixel, vec4(encodeSrgb3(color), 1.0f));
}
