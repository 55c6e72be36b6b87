// SPDX-License-Identifier: MIT
// Recursive ray reveal: from the surface a masked pixel shows, on along the view ray until another
// object is met. Writes that object's colour, motion, depth and id.
#ifndef SHUTTER_MOTION_BLUR_REVEAL_GLSL
#define SHUTTER_MOTION_BLUR_REVEAL_GLSL

#include "motion_blur/next_surface.glsl"
#include "motion_blur/revealed_pixels.glsl"
#include "render/blended_layers.glsl"
#include "render/point_motion.glsl"
#include "render/view_ray.glsl"

layout(constant_id = 0) const uint kBlended = 0u; // 1: blended surfaces may be in the picture

layout(set = 0, binding = 8) uniform accelerationStructureEXT uScene;

Revealed revealHit(FrameRef frame, RayHit rayHit, vec2 centre, vec3 direction) {
    ShadedHit shaded = shadeRasterHit(frame, rayHit.id, direction);
    vec2 motion = motionOfPoint(frame, rayHit.id, shaded.objectPosition);
    float depth = dot(shaded.relWorldPosition, frame.value.forward.xyz);
    return Revealed(shaded.color, vec4(motion, depth, 0.0f), rayHit.id.entity);
}

/// The background revealed at a masked pixel.
/// \param rays number of rays traced
Revealed traceReveal(ivec2 pixel, out uint rays) {
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 uv = centre / vec2(params.sizePx);
    Revealed revealed = keepRaster(uv); // also where a limit of one level reveals nothing
    uint frontId = revealed.entityId;
    rays = 0u;
    if (frontId == kNoEntity) return revealed; // nothing hides the sky

    FrameRef frame = FrameRef(method.frame);
    if (!hasEntityRow(frame, frontId)) return revealed; // a host's, of which nothing is known
    ViewRay ray = makeViewRay(frame, centre);
    // The raster image is the first hit: its depth along the view gives the distance on the ray.
    float frontDepth = revealed.motionDepth.z;
    float frontLuminance = luminance(revealed.color);
    float along = max(dot(ray.direction, frame.value.forward.xyz), 1.0e-6f);
    float t = (frontDepth - dot(ray.origin, frame.value.forward.xyz)) / along;

    float error = rasterHitError(t, frame.value.pixelFootprint);
    // One ray is enough where it passes all of the front entity: left out by the mask, which costs
    // nothing, or else candidate by candidate.
    bool single = (method.flags & kFlagSteppingReveal) == 0u;
    uint passedMask =
        single ? EntityTable(frame.value.entities).rows[frontId].instanceMask : 0u;
    bool byLuminance = (method.flags & kFlagLuminanceTest) != 0u;
    uint limit = single ? 2u : method.recursionLimit;
    uint leftId = passedMask != 0u ? kNoEntity : frontId;
    for (uint level = 1u; level < limit; ++level) {
        // A new origin rather than a longer tMin: builders' boxes in front of it are then skipped.
        float start = max(t - error, 0.0f);
        RayHit hit = traceRay(
            uScene, frame, ray.origin + start * ray.direction, ray.direction, 0.0f, 1.0e30f,
            kSolidMask & ~passedMask, LeftSurface(leftId, single ? 1.0e30f : t + error - start)
        );
        ++rays;
        if (!hit.found) {
            revealed = revealSky(
                frame, backgroundRadiance(frame, ray.direction), centre, ray.direction
            );
            t = 1.0e30f;
            break;
        }
        // nor is its background known
        if (!hasEntityRow(frame, hit.id.entity)) return keepRaster(uv);
        t = start + hit.t;
        error = rayHitError(t);
        leftId = hit.id.entity;
        bool last = level + 1u == limit;
        bool other = hit.id.entity != frontId;
        if (!byLuminance && !other && !last) continue;
        revealed = revealHit(frame, hit, centre, ray.direction);
        if (byLuminance)
            other = abs(luminance(revealed.color) - frontLuminance) > method.luminanceThreshold;
        if (other) break;
    }
    // The raster's colour has the blended surfaces in it, the revealed one has to as well.
    if (kBlended != 0u && rays > 0u)
        revealed.color = seenThroughBlended(
            uScene, frame, ray.origin, ray.direction, t, frontId, revealed.color
        );
    return revealed;
}

/// \param index of the list of masked pixels; beyond its end nothing is done
void revealPixel(uint index) {
    if (index >= header.listedPixels) return;
    uint entry = pixels[index];
    uint rays;
    Revealed revealed = traceReveal(pixelOf(entry), rays);
    if (rays > 1u) atomicAdd(header.extraRays, rays - 1u);
    if (rays == 0u) atomicAdd(header.raylessPixels, 1u);
    storeRevealed(entry, revealed);
}

#endif
