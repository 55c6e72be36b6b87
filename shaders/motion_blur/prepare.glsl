// SPDX-License-Identifier: MIT
// A host's motion vectors and depth as the motion blur takes them.
#ifndef SHUTTER_PREPARE_GLSL
#define SHUTTER_PREPARE_GLSL

#include "common/numeric.glsl"
#include "common/pixel_way.glsl"
#include "motion_blur/prepare_shared.h"
#include "render/motion.glsl"
#include "render/scene_shared.h"

SHUTTER_SHADER_BEGIN

SHUTTER_INLINE bool prepareHas(PrepareTable table, uint flag) {
    return (table.flags & flag) != 0u;
}

/// Texture coordinates of a place of the picture, pixels.
SHUTTER_INLINE vec2 placeInArea(PrepareArea area, vec2 place) {
    return area.origin + place * area.perPixel;
}

/// Whether the pixel is the view model's. \param value of depth, as it is stored
SHUTTER_INLINE bool isViewModel(PrepareTable table, float value) {
    return prepareHas(table, kPrepareHasViewModel) && value != table.skyValue &&
           value >= table.viewModelRange.x && value <= table.viewModelRange.y;
}

/// Metres along the view, (0, kSkyDepth]; the latter for the sky and for invalid depths.
SHUTTER_INLINE float metresOfDepth(PrepareTable table, float value) {
    if (!isFinite(value) || value == table.skyValue)
        return kSkyDepth;
    if (prepareHas(table, kPrepareSkyBeyond) && value > table.skyValue)
        return kSkyDepth;
    vec4 k = isViewModel(table, value) ? table.viewModelFromValue : table.depthFromValue;
    float metres = (k.x + k.y * value) / (k.z + k.w * value);
    return isFinite(metres) && metres > 0.0f ? min(metres, kSkyDepth) : kSkyDepth;
}

/// Displacement of a static point during a frame by camera motion, pixels. 0 if it is unknown.
SHUTTER_INLINE vec2 motionOfCamera(PrepareTable table, vec2 place, float metres) {
    bool isSky = metres >= kSkyDepth;
    bool isPerspective = prepareHas(table, kPreparePerspective);
    // An orthographic camera sees the sky alike from everywhere.
    if (isSky && !isPerspective)
        return vec2(0.0f);
    // The sky is a direction: nothing of the translation counts.
    vec4 now = isPerspective
                   ? (isSky ? vec4(place, 1.0f, 0.0f) : vec4(place * metres, metres, 1.0f))
                   : vec4(place, metres, 1.0f);
    vec3 before = vec3(
        dot(table.beforeFromNow[0], now),
        dot(table.beforeFromNow[1], now),
        dot(table.beforeFromNow[2], now)
    );
    vec2 from = vec2(before.x, before.y);
    if (isPerspective) {
        // A point that was behind the camera starts from where it was last in front.
        vec3 visible = vec3(now.x, now.y, now.z);
        before = pullInFront(before, visible, 1.0e-3f * visible.z);
        from = vec2(before.x, before.y) / before.z;
    }
    return place - from;
}

/// Clamps a motion so that every later sum is finite; 0 for NaN.
SHUTTER_INLINE vec2 storableMotion(vec2 motion) {
    float speed = length(motion);
    if (!isFinite(speed))
        return vec2(0.0f);
    return speed > kMaxMotionPx ? motion * (kMaxMotionPx / speed) : motion;
}

/// Displacement over the exposure, pixels right and down.
/// \param vector as it is in the image
/// \param isOwn the view model's, which no camera moves
/// \param blurScale of the pixel, [0, 1]
SHUTTER_INLINE vec2 preparedMotion(
    PrepareTable table, vec2 place, vec2 vector, float metres, bool isOwn, float blurScale
) {
    vec2 own = vector * table.pixelsPerUnit - table.jitterPx;
    // Scales of 0 must not meet infinity.
    if (!isFinite(own.x) || !isFinite(own.y))
        own = vec2(0.0f);
    if (isOwn || !prepareHas(table, kPrepareHasCameras))
        return storableMotion(own * (table.objectScale * blurScale));
    vec2 camera = motionOfCamera(table, place, metres);
    if (!isFinite(camera.x) || !isFinite(camera.y))
        camera = vec2(0.0f);
    vec2 object = prepareHas(table, kPrepareVectorsHaveCamera) ? own - camera : own;
    // Hosts seldom write vectors where nothing is drawn.
    if (metres >= kSkyDepth)
        object = vec2(0.0f);
    vec2 motion = camera * table.cameraScale + object * table.objectScale;
    return storableMotion(motion * blurScale);
}

/// The motion of a pixel's surface, packed by packWay(): a parabola through its places at shutter
/// open and close and the pixel itself, or straight where the raster is too near to either end.
/// \param ends displacement to shutter open (xy) and close (zw), pixels right and down
/// \param rasterTime shutter time of the raster, which may lie outside of the exposure
/// \return kNoWay in x for NaN
SHUTTER_INLINE uvec2 prepareWay(vec4 ends, float rasterTime) {
    if (!isFinite(ends.x) || !isFinite(ends.y) || !isFinite(ends.z) || !isFinite(ends.w))
        return uvec2(kNoWay, 0u);
    PixelWay way;
    way.open = storableMotion(vec2(ends.x, ends.y));
    way.close = storableMotion(vec2(ends.z, ends.w));
    way.bend = vec2(0.0f);
    const float kMinShare = 0.36f; // at 0.1 and 0.9
    float share = 4.0f * rasterTime * (1.0f - rasterTime); // of the bend, at the raster
    if (isFinite(share) && abs(share) > kMinShare)
        way.bend = (way.open + (way.close - way.open) * rasterTime) * (-1.0f / share);
    return packWay(way);
}

SHUTTER_SHADER_END

#endif
