// SPDX-License-Identifier: MIT
// Motion in the picture of a point that a ray met.
#ifndef SHUTTER_POINT_MOTION_GLSL
#define SHUTTER_POINT_MOTION_GLSL

#include "render/hit.glsl"
#include "render/motion.glsl"

/// Displacement over the whole exposure in pixels (motionFromClip).
/// \param objectPosition of the point, where its shape is static
vec2 motionOfPoint(FrameRef frame, HitId id, vec3 objectPosition) {
    EntityTable entities = EntityTable(frame.value.entities);
    uint motion = entities.rows[id.entity].motion;
    if (motion == kNoMotion) return vec2(0.0f);
    PointPath path = fetchPath(frame, id, objectPosition);
    MotionTable motions = MotionTable(frame.value.entityMotions);
    vec4 open = motions.rows[motion].clipFromObjectOpen * vec4(path.open, 1.0f);
    vec4 visible = entities.rows[id.entity].clipFromObjectRaster * vec4(path.raster, 1.0f);
    vec4 close = motions.rows[motion].clipFromObjectClose * vec4(path.close, 1.0f);
    return motionFromClip(
        open.xyw, close.xyw, visible.xyw, frame.value.forward.w, frame.value.sizePx
    );
}

#endif
