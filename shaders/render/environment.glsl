// SPDX-License-Identifier: MIT
// Light from everywhere: one colour (FrameConstants::ambient before FrameConstants::background), or an
// environment's pictures of all directions.
#ifndef SHUTTER_ENVIRONMENT_GLSL
#define SHUTTER_ENVIRONMENT_GLSL

#include "render/irradiance.glsl"
#include "render/scene_bindings.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer EnvironmentRef {
    EnvironmentConstants value;
};

bool hasEnvironment(FrameRef frame) {
    return (frame.value.flags & kFrameEnvironment) != 0u;
}

vec3 toEnvironmentMap(EnvironmentRef environment, vec3 direction) {
    return vec3(
        dot(environment.value.mapFromWorld[0].xyz, direction),
        dot(environment.value.mapFromWorld[1].xyz, direction),
        dot(environment.value.mapFromWorld[2].xyz, direction)
    );
}

/// The background; always storable in a half-float image.
/// \param direction unit
vec3 backgroundRadiance(FrameRef frame, vec3 direction) {
    if (!hasEnvironment(frame)) return frame.value.background.rgb;
    EnvironmentRef environment = EnvironmentRef(frame.value.environment);
    // A pixel's angle in texels; an orthographic camera sees one direction alone.
    float texels = frame.value.pixelFootprint.x * environment.value.texelsPerRadian;
    float level = max(log2(max(texels, 1.0f)) + frame.value.lodBias, 0.0f);
    vec2 uv = equirectangularPlace(toEnvironmentMap(environment, direction));
    return sampleSceneTexture(environment.value.background, uv, level).rgb;
}

/// The environment's light that a surface reflects.
/// \param diffuse, mirrored shares of it, per channel
/// \param normal, towardsViewer unit
vec3 reflectEnvironment(
    FrameRef frame, vec3 diffuse, vec3 mirrored, float roughness, vec3 normal, vec3 towardsViewer
) {
    if (!hasEnvironment(frame)) return frame.value.ambient.rgb * (diffuse + mirrored);
    EnvironmentRef environment = EnvironmentRef(frame.value.environment);
    vec3 n = toEnvironmentMap(environment, normal);
    vec3 r = toEnvironmentMap(environment, reflect(-towardsViewer, normal));
    vec3 around = sampleSceneTexture(
        environment.value.mirrored, equirectangularPlace(r),
        roughness * environment.value.roughestLevel
    ).rgb;
    return diffuse * evaluateIrradiance(environment.value.irradiance, n) + mirrored * around;
}

#endif
