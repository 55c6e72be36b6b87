// SPDX-License-Identifier: MIT
// Temporal anti-aliasing: each frame samples another place in the pixel, and the last picture,
// found where the surface was seen in it, carries the samples of the frames before.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "common/picture_space.glsl"
#include "render/scene_shared.h"
#include "taa/taa.glsl"
#include "taa/taa_shared.h"

const int kGroup = 8;
const int kTile = kGroup + 2; // a pixel more on each side

layout(local_size_x = kGroup, local_size_y = kGroup) in;

layout(push_constant, scalar) uniform Push {
    TaaParams params;
};

layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform usampler2D uEntityId;
layout(binding = 3) uniform sampler2D uLast; // rgb colour, a count; linear
layout(binding = 4, rgba16f) uniform writeonly image2D uPicture;
layout(binding = 5, rgba16f) uniform writeonly image2D uKept;
layout(binding = 6) uniform sampler2D uLastDepth; // metres along the view direction
layout(binding = 7, r32f) uniform writeonly image2D uKeptDepth;

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

/// Where a surface was seen in the last picture.
struct Before {
    bool isKnown;      // false: it was nowhere
    vec2 displacement; // from its place in this picture
    float depth;       // metres
};

Before findBefore(ivec2 pixel) {
    pixel = clamp(pixel, ivec2(0), ivec2(params.sizePx) - 1);
    vec3 motionDepth = textureLod(uMotionDepth, uvOf(pixel), 0.0f).xyz;
    uint entity = textureLod(uEntityId, uvOf(pixel), 0.0f).r;
    uint mover = kSkyMover;
    if (entity != kNoEntity)
        mover = MoverTable(params.last.movers).movers[min(entity, params.last.rowCount)];
    if (mover == kNoMover)
        return Before(false, vec2(0.0f), 0.0f);
    if (mover == kDeformedMover)
        return Before(true, -motionDepth.xy * params.motionScale, motionDepth.z);
    if (params.last.isStill != 0u && (mover == kWorldMover || mover == kSkyMover))
        return Before(true, vec2(0.0f), motionDepth.z);
    bool perspective = params.isPerspective != 0u;
    // The sample lies where the jitter put it. A direction has no place: its depth is 1.
    vec2 at = vec2(pixel) + 0.5f + params.jitterPx;
    vec4 point = pictureSpace(at, mover == kSkyMover ? 1.0f : motionDepth.z, perspective);
    vec3 before = transformRows(
        InstantMotionTable(params.last.motions).motions[mover].instantFromRaster, point
    );
    if (perspective && before.z <= kLeastDepth)
        return Before(false, vec2(0.0f), 0.0f);
    vec2 displacement = projectPicture(before, perspective) - at;
    bool isKnown = isFinite(displacement.x) && isFinite(displacement.y);
    return Before(isKnown, displacement, mover == kSkyMover ? motionDepth.z : before.z);
}

/// What the group's pixels and those around them show: compressed YCoCg, depth.
shared vec4 tile[kTile * kTile];

void fillTile() {
    ivec2 corner = kGroup * ivec2(gl_WorkGroupID.xy) - 1;
    for (uint i = gl_LocalInvocationIndex; i < uint(kTile * kTile); i += uint(kGroup * kGroup)) {
        vec2 uv = uvOf(corner + ivec2(i % kTile, i / kTile));
        tile[i] = vec4(
            ycocgFromRgb(compress(textureLod(uColor, uv, 0.0f).rgb)),
            textureLod(uMotionDepth, uv, 0.0f).z
        );
    }
}

/// A pixel with those around it.
struct Neighbourhood {
    ColorMoments moments; // compressed YCoCg
    vec3 middle;          // what is seen at the pixel's middle, in the same encoding
    vec3 nearest;         // its place from the pixel, pixels; depth
    vec3 farthest;
};

Neighbourhood lookAround() {
    vec3 columns = findMiddleWeights(params.jitterPx.x);
    vec3 rows = findMiddleWeights(params.jitterPx.y);
    uvec2 local = gl_LocalInvocationID.xy;
    float depth = tile[(local.y + 1u) * kTile + local.x + 1u].w;
    Neighbourhood around = Neighbourhood(
        ColorMoments(vec3(0.0f), vec3(0.0f), 0.0f),
        vec3(0.0f),
        vec3(0.0f, 0.0f, depth),
        vec3(0.0f, 0.0f, depth)
    );
    for (uint y = 0u; y < 3u; ++y)
        for (uint x = 0u; x < 3u; ++x) {
            vec4 texel = tile[(local.y + y) * kTile + local.x + x];
            around.moments = addColor(around.moments, texel.rgb);
            around.middle += columns[x] * rows[y] * texel.rgb;
            vec3 place = vec3(float(x) - 1.0f, float(y) - 1.0f, texel.w);
            if (place.z < around.nearest.z)
                around.nearest = place;
            if (place.z > around.farthest.z)
                around.farthest = place;
        }
    return around;
}

/// Depths at which the last frame may have seen the pixel, those of edges that moved along among
/// them. \param depth of the pixel now, and `before` then
DepthRange findDepths(ivec2 pixel, float depth, Before before, Neighbourhood around) {
    DepthRange depths = DepthRange(before.depth, before.depth);
    if (hides(around.nearest.z, depth)) {
        Before edge = findBefore(pixel + ivec2(around.nearest.xy));
        if (edge.isKnown && movesAlong(before.displacement, edge.displacement))
            depths.least = min(depths.least, edge.depth);
    }
    if (hides(depth, around.farthest.z)) {
        Before edge = findBefore(pixel + ivec2(around.farthest.xy));
        if (edge.isKnown && movesAlong(before.displacement, edge.displacement))
            depths.most = max(depths.most, edge.depth);
    }
    return depths;
}

/// The last picture between its texels, by five of the nine taps: the corners weigh next to
/// nothing.
Kept fetchLast(vec2 at, bool isTexel) {
    if (isTexel) {
        vec4 texel = textureLod(uLast, at / vec2(params.sizePx), 0.0f);
        return Kept(texel.rgb, texel.a);
    }
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

/// What is kept of the pixel, where the last picture has it.
/// \param depth of the pixel
Kept blend(ivec2 pixel, vec3 current, float depth, Neighbourhood around) {
    // What has no history is seen through all samples around, as one alone would flicker.
    Kept anew = Kept(expand(rgbFromYcocg(around.middle)), 1.0f);
    if (params.hasLast == 0u)
        return anew;
    Before before = findBefore(pixel);
    vec2 place = vec2(pixel) + 0.5f + before.displacement;
    bool isInside =
        all(greaterThanEqual(place, vec2(0.0f))) && all(lessThanEqual(place, vec2(params.sizePx)));
    if (!before.isKnown || !isInside)
        return anew;
    DepthRange depths = findDepths(pixel, depth, before, around);
    if (!wasSeen(depths, textureLod(uLastDepth, place / vec2(params.sizePx), 0.0f).r))
        return anew;
    Kept last = fetchLast(place, before.displacement == vec2(0.0f));
    return mixWithLast(current, around.moments, last, params.leastShare);
}

void main() {
    fillTile();
    barrier();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx)))
        return;
    vec4 current = textureLod(uColor, uvOf(pixel), 0.0f);
    uvec2 local = gl_LocalInvocationID.xy + 1u;
    float depth = tile[local.y * kTile + local.x].w;
    Kept kept = blend(pixel, current.rgb, depth, lookAround());
    imageStore(uPicture, pixel, vec4(kept.color, current.a));
    imageStore(uKept, pixel, vec4(kept.color, kept.count));
    imageStore(uKeptDepth, pixel, vec4(depth));
}
