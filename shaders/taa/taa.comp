// SPDX-License-Identifier: MIT
// Temporal anti-aliasing: each frame samples another place in the pixel, and the last picture, found
// where the surface was seen in it, carries the samples of the frames before.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "common/picture_space.glsl"
#include "render/scene_shared.h"
#include "taa/taa.glsl"
#include "taa/taa_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { TaaParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform usampler2D uEntityId;
layout(binding = 3) uniform sampler2D uLast; // rgb colour, a count; linear
layout(binding = 4, rgba16f) uniform writeonly image2D uPicture;
layout(binding = 5, rgba16f) uniform writeonly image2D uKept;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MoverTable {
    uint movers[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer InstantMotionTable {
    InstantMotion motions[];
};

vec2 uvOf(ivec2 pixel) {
    ivec2 inside = clamp(pixel, ivec2(0), ivec2(params.sizePx) - 1);
    return (vec2(inside) + 0.5f) / vec2(params.sizePx);
}

/// Where the surface that a pixel shows was seen in the last picture, as a displacement of this
/// one's places. \return false: it was nowhere
bool findDisplacement(ivec2 pixel, vec3 motionDepth, out vec2 displacement) {
    displacement = vec2(0.0f);
    uint entity = textureLod(uEntityId, uvOf(pixel), 0.0f).r;
    uint mover = kSkyMover;
    if (entity != kNoEntity) mover = MoverTable(params.last.movers).movers[min(entity, params.last.rowCount)];
    if (mover == kNoMover) return false;
    if (mover == kDeformedMover) {
        displacement = -motionDepth.xy * params.motionScale;
        return true;
    }
    if (params.last.isStill != 0u && (mover == kWorldMover || mover == kSkyMover)) return true;
    bool perspective = params.isPerspective != 0u;
    // The sample lies where the jitter put it. A direction has no place: its depth is 1.
    vec2 at = vec2(pixel) + 0.5f + params.jitterPx;
    vec4 point = pictureSpace(at, mover == kSkyMover ? 1.0f : motionDepth.z, perspective);
    vec3 before = transformRows(
        InstantMotionTable(params.last.motions).motions[mover].instantFromRaster, point
    );
    if (perspective && before.z <= kLeastDepth) return false;
    displacement = projectPicture(before, perspective) - at;
    return isFinite(displacement.x) && isFinite(displacement.y);
}

/// The last picture between its texels, by five of the nine taps: the corners weigh next to nothing.
Kept fetchLast(vec2 at) {
    CubicTaps taps = findCubicTaps(at);
    vec2 perPixel = 1.0f / vec2(params.sizePx);
    vec2 middle = taps.middle * perPixel;
    vec2 before = taps.before * perPixel;
    vec2 after = taps.after * perPixel;
    vec2 mw = taps.middleWeight;
    vec4 centre = textureLod(uLast, middle, 0.0f);
    float left = taps.beforeWeight.x * mw.y;
    float right = taps.afterWeight.x * mw.y;
    float above = mw.x * taps.beforeWeight.y;
    float below = mw.x * taps.afterWeight.y;
    vec3 sum = centre.rgb * (mw.x * mw.y);
    sum += textureLod(uLast, vec2(before.x, middle.y), 0.0f).rgb * left;
    sum += textureLod(uLast, vec2(after.x, middle.y), 0.0f).rgb * right;
    sum += textureLod(uLast, vec2(middle.x, before.y), 0.0f).rgb * above;
    sum += textureLod(uLast, vec2(middle.x, after.y), 0.0f).rgb * below;
    return Kept(sum / (mw.x * mw.y + left + right + above + below), centre.a);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec4 current = textureLod(uColor, uvOf(pixel), 0.0f);
    Kept kept = Kept(current.rgb, 1.0f);
    if (params.hasLast != 0u) {
        // What is nearest moves the pixels around its edge, too, or its edge would stay behind.
        ColorMoments moments = ColorMoments(vec3(0.0f), vec3(0.0f), 0.0f);
        ivec2 nearest = pixel;
        vec3 nearestMotionDepth = vec3(0.0f, 0.0f, 2.0f * kSkyDepth);
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                ivec2 at = pixel + ivec2(x, y);
                vec3 color = textureLod(uColor, uvOf(at), 0.0f).rgb;
                moments = addColor(moments, ycocgFromRgb(compress(color)));
                vec3 motionDepth = textureLod(uMotionDepth, uvOf(at), 0.0f).xyz;
                if (motionDepth.z >= nearestMotionDepth.z) continue;
                nearest = clamp(at, ivec2(0), ivec2(params.sizePx) - 1);
                nearestMotionDepth = motionDepth;
            }
        vec2 displacement;
        bool isKnown = findDisplacement(nearest, nearestMotionDepth, displacement);
        vec2 before = vec2(pixel) + 0.5f + displacement;
        bool isInside = all(greaterThanEqual(before, vec2(0.0f))) &&
                        all(lessThanEqual(before, vec2(params.sizePx)));
        if (isKnown && isInside)
            kept = mixWithLast(current.rgb, moments, fetchLast(before), params.leastShare);
    }
    imageStore(uPicture, pixel, vec4(kept.color, current.a));
    imageStore(uKept, pixel, vec4(kept.color, kept.count));
}
