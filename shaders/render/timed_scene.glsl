// SPDX-License-Identifier: MIT
// Entities, camera and lights at any shutter time.
#ifndef SHUTTER_MOVING_SCENE_GLSL
#define SHUTTER_MOVING_SCENE_GLSL

#include "common/sampling.glsl"
#include "common/aperture.glsl"
#include "render/hit.glsl"
#include "render/lighting.glsl"
#include "render/timed_scene_shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer TimedRef {
    TimedConstants value;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer TimedTable {
    TimedRow rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer KeyTable {
    MotionKey keys[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer LensTable {
    LensKey keys[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer BoxTable {
    uint rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ShapeSceneTable {
    uvec2 addresses[];
};

/// Which two of `count` uniform keys s lies between, and how far.
void findKeys(uint count, float s, out uint first, out float blend) {
    float at = saturate(s) * float(count - 1u);
    first = min(uint(at), max(count, 2u) - 2u);
    blend = at - float(first);
}

void interpolate(uvec2 table, uint count, float s, out vec4 rows[3]) {
    KeyTable keys = KeyTable(table);
    if (count == 1u) {
        rows = keys.keys[0].rows;
        return;
    }
    uint first;
    float blend;
    findKeys(count, s, first, blend);
    for (int i = 0; i < 3; ++i)
        rows[i] = mix(keys.keys[first].rows[i], keys.keys[first + 1u].rows[i], blend);
}

float determinantOf(vec4 rows[3]) {
    return dot(cross(rows[0].xyz, rows[1].xyz), rows[2].xyz);
}

Placement placeAt(TimedRef moving, uint entity, float s) {
    TimedTable table = TimedTable(moving.value.rows);
    Placement placement;
    placement.firstGeometry = table.rows[entity].firstGeometry;
    interpolate(table.rows[entity].keys, table.rows[entity].keyCount, s, placement.relWorldFromObject);
    placement.handedness = table.rows[entity].handedness;
    if (determinantOf(placement.relWorldFromObject) < 0.0f) placement.handedness *= -1.0f;
    uint deformationKeyCount = table.rows[entity].deformationKeyCount;
    placement.deforms = deformationKeyCount > 1u;
    findKeys(deformationKeyCount, s, placement.firstKey, placement.keyBlend);
    return placement;
}

LightSet lightsAt(TimedRef moving, float s) {
    uvec2 table = moving.value.lights;
    uint count = moving.value.lightCount;
    uint keys = moving.value.lightKeyCount;
    if (keys == 1u) return LightSet(table, table, 0.0f, count);
    uint first;
    float blend;
    findKeys(keys, s, first, blend);
    // 64 bytes per light; tables are far smaller than 4 GiB.
    uint carry;
    uint at = first * count * 64u;
    uvec2 near = uvec2(uaddCarry(table.x, at, carry), table.y);
    near.y += carry;
    uvec2 far = uvec2(uaddCarry(near.x, count * 64u, carry), near.y);
    far.y += carry;
    return LightSet(near, far, blend, count);
}

struct ShutterRay {
    vec3 origin;    // camera-relative space, on the near plane
    vec3 direction; // unit
    vec3 eye;       // place of the camera, camera-relative space
    vec3 forward;   // of the view, unit
};

/// The ray of a place in the picture at shutter time s. It starts where raster clips.
/// \param screenPx pixels from the top left corner, without the picture's jitter
ShutterRay makeShutterRay(FrameRef frame, TimedRef moving, vec2 screenPx, float s) {
    vec4 rows[3];
    interpolate(moving.value.cameraKeys, moving.value.cameraKeyCount, s, rows);
    vec2 ndc = (screenPx + moving.value.jitterPx) / frame.value.sizePx * 2.0f - 1.0f;
    vec4 view = moving.value.view;
    vec2 across = vec2(ndc.x, -ndc.y) * view.xy;
    bool perspective = view.w > 0.0f;
    vec3 direction = perspective ? vec3(across, -1.0f) : vec3(0.0f, 0.0f, -1.0f);
    vec4 near = vec4(perspective ? across * view.z : across, -view.z, 1.0f);
    ShutterRay ray;
    ray.origin = vec3(dot(rows[0], near), dot(rows[1], near), dot(rows[2], near));
    ray.direction = normalize(vec3(
        dot(rows[0].xyz, direction), dot(rows[1].xyz, direction), dot(rows[2].xyz, direction)
    ));
    ray.eye = vec3(rows[0].w, rows[1].w, rows[2].w);
    ray.forward = normalize(-vec3(rows[0].z, rows[1].z, rows[2].z));
    return ray;
}

LensKey lensAt(TimedRef moving, float s) {
    LensTable table = LensTable(moving.value.lensKeys);
    if (moving.value.lensKeyCount == 1u) return table.keys[0];
    uint first;
    float blend;
    findKeys(moving.value.lensKeyCount, s, first, blend);
    LensKey from = table.keys[first];
    LensKey to = table.keys[first + 1u];
    return LensKey(mix(from.radius, to.radius, blend), mix(from.focus, to.focus, blend));
}

/// The same from a place of the lens, through the point in focus that the ray of its middle meets.
/// \param index, seed of lensPlace()
ShutterRay
makeLensRay(FrameRef frame, TimedRef moving, vec2 screenPx, uint index, uint seed, float s) {
    ShutterRay ray = makeShutterRay(frame, moving, screenPx, s);
    if (moving.value.lensKeyCount == 0u) return ray;
    LensKey lens = lensAt(moving, s);
    vec4 shape = moving.value.aperture;
    Aperture aperture = Aperture(uint(shape.x), shape.y, shape.z, shape.w);
    vec2 aside = lens.radius * aperturePoint(aperture, lensPlace(index, seed));
    vec4 rows[3];
    interpolate(moving.value.cameraKeys, moving.value.cameraKeyCount, s, rows);
    vec3 right = normalize(vec3(rows[0].x, rows[1].x, rows[2].x));
    vec3 up = normalize(vec3(rows[0].y, rows[1].y, rows[2].y));
    vec3 shift = aside.x * right + aside.y * up;
    // On the way it goes forward by 1.
    vec3 step_ = ray.direction / dot(ray.direction, ray.forward) - lens.focus * shift;
    ray.eye += shift;
    ray.origin = ray.eye + moving.value.view.z * step_;
    ray.direction = normalize(step_);
    return ray;
}

#endif
