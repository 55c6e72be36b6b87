// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/pixel_way.glsl"
#include "render/motion.glsl"
#include "render/shape_ways_shared.h"

/// Share of its depth that a surface may be off the one that the raster shows: what hides it there, or
/// was cut out of it by an alpha mask, is elsewhere.
const float kSameDepth = 1.0e-3f;

layout(push_constant, scalar) uniform Push { ShapeWayDraw draw; };
layout(binding = 0) uniform usampler2D uSurface; // bits of the depth; the key

layout(location = 0) in vec4 inRaster;
layout(location = 1) in vec3 inOpen;
layout(location = 2) in vec3 inMiddle;
layout(location = 3) in vec3 inClose;

layout(location = 0) out uvec2 outWay;

/// As far as a way may lead. 0: it is nowhere.
vec2 displacementTo(vec3 there, vec2 here) {
    vec3 seen = pullInFront(there, inRaster.xyz, draw.leastQ);
    vec2 displacement = seen.xy / seen.z - here;
    float distance_ = length(displacement);
    if (!isFinite(distance_)) return vec2(0.0f);
    return displacement * min(1.0f, kMaxMotionPx / max(distance_, 1.0f));
}

void main() {
    uvec2 surface = texelFetch(uSurface, ivec2(gl_FragCoord.xy), 0).xy;
    bool isSame = (surface.y & draw.keyMask) == draw.key &&
                  abs(uintBitsToFloat(surface.x) - inRaster.w) <= kSameDepth * abs(inRaster.w);
    if (!isSame) discard;
    vec2 here = inRaster.xy / inRaster.z;
    PixelWay way;
    way.open = displacementTo(inOpen, here);
    way.close = displacementTo(inClose, here);
    way.bend = displacementTo(inMiddle, here) - 0.5f * (way.open + way.close);
    outWay = packWay(way);
}
