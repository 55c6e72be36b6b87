// SPDX-License-Identifier: MIT
#ifndef SHUTTER_VIEW_RAY_GLSL
#define SHUTTER_VIEW_RAY_GLSL

#include "render/scene_bindings.glsl"

struct ViewRay {
    vec3 origin;    // camera-relative space, on the near plane
    vec3 direction; // unit
};

/// The ray of a pixel, for either kind of camera. It starts where raster clips: at the near plane.
ViewRay makeViewRay(FrameRef frame, vec2 screenPx) {
    vec2 ndc = screenPx / frame.value.sizePx * 2.0f - 1.0f;
    vec4 near = frame.value.relWorldFromClip * vec4(ndc, 1.0f, 1.0f);
    vec4 beyond = frame.value.relWorldFromClip * vec4(ndc, 0.5f, 1.0f);
    ViewRay ray;
    ray.origin = near.xyz / near.w;
    ray.direction = normalize(beyond.xyz / beyond.w - ray.origin);
    return ray;
}

#endif
