// SPDX-License-Identifier: MIT
// Distributed ray tracing (Cook, Porter and Carpenter 1984), of motion and lens: what one ray sees at
// one time of the exposure.
#ifndef SHUTTER_DISTRIBUTED_RAY_GLSL
#define SHUTTER_DISTRIBUTED_RAY_GLSL

#include "render/timed_trace.glsl"
#include "render/shade_hit.glsl"

struct DistributedSample {
    vec3 radiance;       // linear, blended surfaces composited over their background
    HitId id;            // its entity is kNoEntity where nothing was met. This and all below: of the
                         // first surface that is not blended
    float depth;         // metres along the view direction of that time; kSkyDepth: nothing
    vec3 normal;         // world axes, unit; 0: nothing
    vec3 objectPosition; // where on the entity, its own space
    vec3 relWorldPosition;    // camera-relative space, at that time
    uint rays;           // traced for it
};

/// Start of a ray to a light off its surface, metres, for the rounding of where it is.
float lightRayOffset(vec3 position) {
    vec3 a = abs(position);
    return 2.0e-5f * max(max(a.x, a.y), max(a.z, 1.0e-2f));
}

/// Lights that the point does not see at the query's time, a bit each.
/// \param query of the ray that met the point
uint traceDarkness(
    accelerationStructureEXT scene, FrameRef frame, TimedRef moving, SurfacePoint point,
    vec3 direction, TimedQuery query, LightSet lights
) {
    if (!hasSlot(frame, kSlotOcclusion)) return 0u;
    vec3 normal = safeNormalize(point.geometricNormal, -direction);
    query.mask = kSolidMask;
    query.tMin = 0.0f;
    query.endsAnywhere = true;
    uint dark = 0u;
    for (uint i = 0u; i < min(lights.count, kMaxOccludedLights); ++i) {
        LightRow light = lightAt(lights, i);
        vec3 toLight;
        vec3 irradiance;
        evaluateLight(light, point.relWorldPosition, toLight, irradiance);
        if (irradiance == vec3(0.0f)) continue;
        vec3 side = dot(normal, toLight) < 0.0f ? -normal : normal;
        vec3 start = point.relWorldPosition + side * lightRayOffset(point.relWorldPosition);
        query.tMax = light.kind == kLightDirectional
                         ? 1.0e30f
                         : distance(light.positionRange.xyz, point.relWorldPosition);
        if (traceTimedRay(scene, frame, moving, start, toLight, query).found) dark |= 1u << i;
    }
    return dark;
}

/// \param ray of makeShutterRay() or makeLensRay()
/// \param s its shutter time, [0, 1]
DistributedSample traceDistributed(
    accelerationStructureEXT scene, FrameRef frame, TimedRef moving, ShutterRay ray, float s
) {
    LightSet lights = lightsAt(moving, s);
    DistributedSample result;
    result.radiance = vec3(0.0f);
    result.id = HitId(kNoEntity, 0u, 0u, vec2(0.0f));
    result.depth = kSkyDepth;
    result.normal = vec3(0.0f);
    result.objectPosition = vec3(0.0f);
    result.relWorldPosition = vec3(0.0f);
    result.rays = 0u;
    float transmitted = 1.0f;
    TimedQuery query = TimedQuery(s, ray.eye, kSolidMask | kBlendedMask, 0.0f, 1.0e30f, false);
    while (true) {
        RayHit rayHit =
            traceTimedRay(scene, frame, moving, ray.origin, ray.direction, query);
        ++result.rays;
        if (!rayHit.found) {
            result.radiance += transmitted * backgroundRadiance(frame, ray.direction);
            break;
        }
        Placement placement = placeAt(moving, rayHit.id.entity, s);
        Hit hit = fetchHit(frame, placement, rayHit.id);
        uint dark = traceDarkness(scene, frame, moving, hit.point, ray.direction, query, lights);
        ShadedHit shaded = shadeHit(
            frame, hit, ray.direction, ray.eye, lights, lightAccessByRays(rayHit.id.entity, dark)
        );
        // Behind so many layers the next is taken for opaque.
        bool last = shaded.alpha >= 1.0f || result.rays == kMaxLayers;
        result.radiance += transmitted * (last ? 1.0f : shaded.light) * shaded.color;
        if (last) {
            result.id = rayHit.id;
            result.depth = dot(shaded.relWorldPosition - ray.eye, ray.forward);
            result.normal = shaded.normal;
            result.objectPosition = shaded.objectPosition;
            result.relWorldPosition = shaded.relWorldPosition;
            break;
        }
        transmitted *= 1.0f - shaded.alpha;
        query.tMin = rayHit.t; // the surface itself is excluded: the interval is open
    }
    return result;
}

#endif
