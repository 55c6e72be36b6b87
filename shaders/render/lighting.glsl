// SPDX-License-Identifier: MIT
#ifndef SHUTTER_LIGHTING_GLSL
#define SHUTTER_LIGHTING_GLSL

/// Slots that a shader may read, a bit each; one that knows them defines this before including this
/// file.
#ifndef SHUTTER_SHADING_SLOTS
#define SHUTTER_SHADING_SLOTS ~0u
#endif

#include "render/brdf.glsl"
#include "render/environment.glsl"
#include "render/shading.glsl"
#include "render/surface.glsl"

/// Direction to the light (unit) and the irradiance it gives a surface facing it.
void evaluateLight(LightRow light, vec3 position, out vec3 toLight, out vec3 irradiance) {
    if (light.kind == kLightDirectional) {
        toLight = -light.direction.xyz;
        irradiance = light.radiance.rgb;
        return;
    }
    vec3 offset = light.positionRange.xyz - position;
    float distance2 = max(dot(offset, offset), 1.0e-6f);
    float distance_ = sqrt(distance2);
    toLight = offset / distance_;
    float attenuation = 1.0f / distance2;
    if (light.positionRange.w > 0.0f) {
        // KHR_lights_punctual, "Range Property".
        float x = distance_ / light.positionRange.w;
        float x2 = x * x;
        attenuation *= saturate(1.0f - x2 * x2);
    }
    if (light.kind == kLightSpot) {
        float angular =
            saturate(dot(light.direction.xyz, -toLight) * light.spotScale + light.spotOffset);
        attenuation *= angular * angular;
    }
    irradiance = light.radiance.rgb * attenuation;
}

/// All lights at one instant: between two tables.
struct LightSet {
    uvec2 first;  // address of LightRow[]
    uvec2 second;
    float blend;  // 0: the first, 1: the second
    uint count;
};

LightSet lightsAtRaster(FrameRef frame) {
    return LightSet(frame.value.lights, frame.value.lights, 0.0f, frame.value.lightCount);
}

LightRow lightAt(LightSet lights, uint index) {
    LightRow light = LightTable(lights.first).rows[index];
    if (lights.blend > 0.0f) {
        LightTable second = LightTable(lights.second);
        light.positionRange =
            mix(light.positionRange, second.rows[index].positionRange, lights.blend);
        light.radiance = mix(light.radiance, second.rows[index].radiance, lights.blend);
        light.direction.xyz = safeNormalize(
            mix(light.direction.xyz, second.rows[index].direction.xyz, lights.blend),
            light.direction.xyz
        );
    }
    return light;
}

/// Radiance from the surface towards the camera; always storable in a half-float image.
/// \param position in the lights' space
/// \param viewDirection unit, from the camera to the surface
vec3 shadeSurface(
    FrameRef frame, MaterialRow material, Surface surface, vec3 position, vec3 viewDirection,
    LightSet lights, LightAccess access
) {
    if ((frame.value.flags & kFrameUnlit) != 0u || (material.flags & kMaterialUnlit) != 0u)
        return storableColor(surface.baseColor);
    vec3 v = -viewDirection;
    float roughness = max(surface.roughness, kMinRoughness);
    vec3 f0 = mix(vec3(0.04f), surface.baseColor, surface.metallic);
    vec3 mirrored = environmentBrdf(f0, roughness, saturate(abs(dot(surface.normal, v))));
    vec3 diffuse = surface.baseColor * (1.0f - surface.metallic) * (vec3(1.0f) - mirrored);
    vec3 color =
        surface.occlusion *
        reflectEnvironment(frame, diffuse, mirrored, roughness, surface.normal, v);
    bool mayOcclude =
        (SHUTTER_SHADING_SLOTS >> kSlotOcclusion & 1u) != 0u && hasSlot(frame, kSlotOcclusion);
    for (uint i = 0u; i < lights.count; ++i) {
        vec3 toLight;
        vec3 irradiance;
        LightRow light = lightAt(lights, i);
        evaluateLight(light, position, toLight, irradiance);
        if (mayOcclude && dot(surface.normal, toLight) > 0.0f)
            irradiance *= lightReaching(
                frame, access, i, light, position, surface.geometricNormal, toLight
            );
        color += irradiance * reflectLight(
                                  surface.baseColor, surface.metallic, roughness, surface.normal, v,
                                  toLight
                              );
    }
    return storableColor(color + surface.emissive);
}

#endif
