// SPDX-License-Identifier: MIT
// Lists the regions of the picture that may hold bright points: few do, and the search for points is
// costly where there are none.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/numeric.glsl"
#include "motion_blur/bright_points_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in; // a thread per square of kPointTilePx
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1, scalar) buffer Counts { // cleared
    PointHeader uHeader;
    uint uCounts[];
};
layout(binding = 2, scalar) buffer Regions { // its header is cleared
    RegionHeader uRegionHeader;
    uint uRegions[];
};
layout(binding = 3, scalar) buffer Arguments { DispatchArguments uArguments; };

/// Beyond the border the picture's last pixel counts.
bool isBright() {
    vec2 corner = vec2(gl_GlobalInvocationID.xy * kPointTilePx);
    float brightest = 0.0f;
    for (uint i = 0u; i < kPointTilePx * kPointTilePx; ++i) {
        vec2 pixel = corner + vec2(i % kPointTilePx, i / kPointTilePx) + 0.5f;
        // texelFetch is slow on software devices
        float light = luminance(textureLod(uColor, pixel / vec2(params.sizePx), 0.0f).rgb);
        if (light > brightest) brightest = light; // NaN is none
    }
    return brightest > kMinPointLight;
}

void main() {
    if (!isBright()) return;
    uint across = (params.sizePx.x + kPointRegionPx - 1u) / kPointRegionPx;
    uint region = gl_WorkGroupID.y * across + gl_WorkGroupID.x;
    if (atomicOr(uCounts[region], 1u) != 0u) return; // another thread has listed it
    uint at = atomicAdd(uRegionHeader.count, 1u);
    uRegions[at] = region;
    atomicMax(uArguments.groupsX, min(at + 1u, kRegionRow));
    atomicMax(uArguments.groupsY, at / kRegionRow + 1u);
}
