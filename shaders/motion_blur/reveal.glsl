// SPDX-License-Identifier: MIT
// Recursive ray reveal: from the surface a masked pixel shows, on along the view ray until another
// object is met. Writes that object's colour, motion, depth and id over the raster layer's copy.
#ifndef SHUTTER_MOTION_BLUR_REVEAL_GLSL
#define SHUTTER_MOTION_BLUR_REVEAL_GLSL

#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/next_surface.glsl"
#include "render/blended_layers.glsl"
#include "render/point_motion.glsl"
#include "render/sky.glsl"
#include "render/view_ray.glsl"

layout(constant_id = 0) const uint kBlended = 0u; // 1: blended surfaces may be in the picture

layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(set = 0, binding = 0) uniform accelerationStructureEXT uScene;
layout(set = 0, binding = 1) uniform sampler2D uColor;
layout(set = 0, binding = 2) uniform sampler2D uMotionDepth;
layout(set = 0, binding = 3) uniform usampler2D uMeshId;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D uRevealColor;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D uRevealMotionDepth;
layout(set = 0, binding = 6, r32ui) uniform writeonly uimage2D uRevealMeshId;
layout(set = 0, binding = 7, scalar) buffer MaskList {
    MaskHeader header;
    uint pixels[];
};

struct Revealed {
    vec3 color;
    vec4 motionDepth;
    uint meshId;
};

Revealed revealSky(FrameRef frame, vec2 centre, vec3 direction) {
    return Revealed(
        frame.value.background.rgb,
        vec4(skyMotion(frame, centre, direction), kSkyDepth, 0.0f), kNoEntity
    );
}

Revealed revealHit(FrameRef frame, RayHit rayHit, vec2 centre, vec3 direction) {
    Placement placement = placeAtRaster(frame, rayHit.id.entity);
    ShadedHit shaded =
        shadeHit(frame, placement, rayHit.id, direction, vec3(0.0f), lightsAtRaster(frame));
    vec2 motion = motionOfPoint(frame, rayHit.id, shaded.objectPosition);
    float depth = dot(shaded.eyePosition, frame.value.forward.xyz);
    return Revealed(shaded.color, vec4(motion, depth, 0.0f), rayHit.id.entity);
}

/// \param index of the list of masked pixels; beyond its end nothing is done
void revealPixel(uint index) {
    if (index >= header.maskedPixels) return;
    uint packed_ = pixels[index];
    ivec2 pixel = ivec2(packed_ & 0xFFFFu, packed_ >> 16);
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 uv = centre / vec2(params.sizePx);
    uint frontId = textureLod(uMeshId, uv, 0.0f).x;
    if (frontId == kNoEntity) return; // nothing hides the sky

    FrameRef frame = FrameRef(params.frame);
    ViewRay ray = makeViewRay(frame, centre);
    // The raster image is the first hit: its depth along the view gives the distance on the ray.
    float frontDepth = textureLod(uMotionDepth, uv, 0.0f).z;
    float frontLuminance = luminance(textureLod(uColor, uv, 0.0f).rgb);
    float along = max(dot(ray.direction, frame.value.forward.xyz), 1.0e-6f);
    float t = (frontDepth - dot(ray.origin, frame.value.forward.xyz)) / along;

    float error = rasterHitError(t, frame.value.pixelFootprint);
    // One ray is enough where it passes all of the front entity: left out by the mask, which costs
    // nothing, or else candidate by candidate.
    bool single = params.revealTraversal == kRevealTraversalSingle;
    uint passedMask =
        single ? EntityTable(frame.value.entities).rows[frontId].rayMask : 0u;
    uint limit = single ? 2u : params.recursionLimit;
    uint leftId = passedMask != 0u ? kNoEntity : frontId;
    Revealed revealed;
    uint rays = 0u;
    for (uint level = 1u; level < limit; ++level) {
        // A new origin rather than a longer tMin: builders' boxes in front of it are then skipped.
        float start = max(t - error, 0.0f);
        RayHit hit = traceRay(
            uScene, frame, ray.origin + start * ray.direction, ray.direction, 0.0f, 1.0e30f,
            kSolidMask & ~passedMask, LeftSurface(leftId, single ? 1.0e30f : t + error - start)
        );
        ++rays;
        if (!hit.found) {
            revealed = revealSky(frame, centre, ray.direction);
            t = 1.0e30f;
            break;
        }
        t = start + hit.t;
        error = rayHitError(t);
        leftId = hit.id.entity;
        bool last = level + 1u == limit;
        bool other = hit.id.entity != frontId;
        if (params.objectTest == kObjectTestMeshId && !other && !last) continue;
        revealed = revealHit(frame, hit, centre, ray.direction);
        if (params.objectTest == kObjectTestLuminance)
            other = abs(luminance(revealed.color) - frontLuminance) > params.luminanceThreshold;
        if (other) break;
    }
    atomicAdd(header.raysTraced, rays);
    if (rays == 0u) return; // a limit of one level reveals nothing
    // The raster's colour has the blended surfaces in it, the revealed one has to as well.
    if (kBlended != 0u)
        revealed.color = seenThroughBlended(
            uScene, frame, ray.origin, ray.direction, t, frontId, revealed.color
        );
    imageStore(uRevealColor, pixel, vec4(revealed.color, 1.0f));
    imageStore(uRevealMotionDepth, pixel, revealed.motionDepth);
    imageStore(uRevealMeshId, pixel, uvec4(revealed.meshId, 0u, 0u, 0u));
}

#endif
