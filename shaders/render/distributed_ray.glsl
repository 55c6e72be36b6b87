// SPDX-License-Identifier: MIT
// Distributed ray tracing (Cook, Porter and Carpenter 1984), the motion part: what one place of the
// picture shows at one time of the exposure.
#ifndef SHUTTER_DISTRIBUTED_RAY_GLSL
#define SHUTTER_DISTRIBUTED_RAY_GLSL

#include "render/timed_trace.glsl"
#include "render/shade_hit.glsl"

struct DistributedSample {
    vec3 radiance;       // linear, blended surfaces composited over what is behind them
    HitId id;            // its entity is kNoEntity where nothing was met. This and all below: of the
                         // first surface that is not blended
    float depth;         // metres along the view direction of that time; kSkyDepth: nothing
    vec3 normal;         // world axes, unit; 0: nothing
    vec3 objectPosition; // where on the entity, its own space
    vec3 eyePosition;    // eye space, at that time
    uint rays;           // traced for it
};

/// \param screenPx pixels from the top left corner
/// \param s shutter time, [0, 1]
DistributedSample traceDistributed(
    accelerationStructureEXT scene, FrameRef frame, TimedRef moving, vec2 screenPx, float s
) {
    ShutterRay ray = makeShutterRay(frame, moving, screenPx, s);
    LightSet lights = lightsAt(moving, s);
    DistributedSample result;
    result.radiance = vec3(0.0f);
    result.id = HitId(kNoEntity, 0u, 0u, vec2(0.0f));
    result.depth = kSkyDepth;
    result.normal = vec3(0.0f);
    result.objectPosition = vec3(0.0f);
    result.eyePosition = vec3(0.0f);
    result.rays = 0u;
    float transmitted = 1.0f;
    TimedQuery query = TimedQuery(s, ray.eye, kSolidMask | kBlendedMask, 0.0f, 1.0e30f);
    while (true) {
        RayHit rayHit =
            traceTimedRay(scene, frame, moving, ray.origin, ray.direction, query);
        ++result.rays;
        if (!rayHit.found) {
            result.radiance += transmitted * frame.value.background.rgb;
            break;
        }
        Placement placement = placeAt(moving, rayHit.id.entity, s);
        Hit hit = fetchHit(frame, placement, rayHit.id);
        ShadedHit shaded = shadeHit(
            frame, hit, ray.direction, ray.eye, lights, ShadowSource(false, 0u, rayHit.id.entity)
        );
        // Behind so many layers the next is taken for opaque.
        bool last = shaded.alpha >= 1.0f || result.rays == kMaxLayers;
        float share = last ? 1.0f : shaded.alpha;
        result.radiance += transmitted * share * shaded.color;
        if (last) {
            result.id = rayHit.id;
            result.depth = dot(shaded.eyePosition - ray.eye, ray.forward);
            result.normal = shaded.normal;
            result.objectPosition = shaded.objectPosition;
            result.eyePosition = shaded.eyePosition;
            break;
        }
        transmitted *= 1.0f - share;
        query.tMin = rayHit.t; // the surface itself is excluded: the interval is open
    }
    return result;
}

#endif
