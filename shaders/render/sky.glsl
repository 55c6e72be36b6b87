// SPDX-License-Identifier: MIT
// The value of a pixel that no entity covers. The same for the raster and for rays that miss.
#ifndef SHUTTER_SKY_GLSL
#define SHUTTER_SKY_GLSL

#include "render/motion.glsl"
#include "render/scene_bindings.glsl"

/// Camera rotation moves the sky too: where the direction was seen at open and at close.
/// \param screenPx the pixel's centre
vec2 skyMotion(FrameRef frame, vec2 screenPx, vec3 direction) {
    vec4 open = frame.value.clipFromRelWorldOpen * vec4(direction, 0.0f);
    vec4 close = frame.value.clipFromRelWorldClose * vec4(direction, 0.0f);
    vec2 ndc = screenPx / frame.value.sizePx * 2.0f - 1.0f;
    // An orthographic camera sees one direction only: its sky does not move.
    if (frame.value.pixelFootprint.y > 0.0f) return vec2(0.0f);
    float cosine = dot(direction, frame.value.forward.xyz);
    // Directions have no distance, so the smallest w in front is a matter of angle.
    return motionFromClip(
        open.xyw, close.xyw, vec3(ndc * cosine, cosine), 1.0e-3f, frame.value.sizePx
    );
}

#endif
