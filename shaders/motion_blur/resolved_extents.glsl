// SPDX-License-Identifier: MIT
// Pixels of one entity in a layer, and their screen extent over the exposure. The including shader
// has the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_EXTENTS_GLSL
#define SHUTTER_RESOLVED_EXTENTS_GLSL

#include "motion_blur/resolved_boxes.glsl"

/// Beyond the box: half a pixel to its border, one for interpolation, and some for rounding.
const float kMarginPx = 2.0f;

const uint kNoSample = 0xFFFFFFFFu;

/// Pixels of one entity.
struct Extent {
    uint key;     // kNoKey: none
    bool isOfUse; // it moves, and it is known how
    bool deforms;
    vec2 depths;
    uvec2 bins; // a bit for each that a pixel lies in (parallax_bins.glsl)
    ivec2 low;
    ivec2 high;
    vec2 motionLow; // of deforming entities: bounds of their motion vectors
    vec2 motionHigh;
};

const Extent kNoExtent = Extent(
    kNoKey, false, false, vec2(3.0e38f, 0.0f), uvec2(0u), ivec2(0x7FFFFFFF), ivec2(-0x7FFFFFFF),
    vec2(3.0e38f), vec2(-3.0e38f)
);

Extent beginExtent(LayerMotion layer, uint key) {
    uint mover = findMover(layer, key);
    Extent extent = kNoExtent;
    extent.key = key;
    extent.isOfUse = mover != kNoMover && !isStillMover(layer, mover);
    extent.deforms = mover == kDeformedMover;
    return extent;
}

// texelFetch is slow on software devices.
vec2 uvOfPixel(ivec2 pixel) { return (vec2(pixel) + 0.5f) / vec2(params.sizePx); }

/// \param surface of the pixel, which is of the extent's entity
void growExtent(uvec2 surface, ivec2 pixel, inout Extent extent) {
    if (!extent.isOfUse) return;
    float depth = depthOfKey(extent.key, uintBitsToFloat(surface.x));
    extent.depths = vec2(min(extent.depths.x, depth), max(extent.depths.y, depth));
    extent.low = min(extent.low, pixel);
    extent.high = max(extent.high, pixel);
}

/// Least and greatest 1 / depth.
vec2 alongsBetween(vec2 depths) {
    vec2 ends = 1.0f / max(depths, vec2(kMinDepth));
    return vec2(ends.y, ends.x);
}

/// \param lensSample whose places of the lens all count, or kNoSample
void addMotion(
    Extent extent, InstantMotion motion, uint instant, uint lensSample, bool perspective,
    inout SeenBox box
) {
    if (motion.instantFromRaster[2] == vec4(0.0f)) return;
    vec2 low = vec2(1.0e9f);
    vec2 high = vec2(-1.0e9f);
    vec2 depths = vec2(3.0e38f, 0.0f);
    bool isInFront = false;
    for (uint corner = 0u; corner < 8u; ++corner) {
        vec2 at = vec2(
            (corner & 1u) != 0u ? float(extent.high.x + 1) : float(extent.low.x),
            (corner & 2u) != 0u ? float(extent.high.y + 1) : float(extent.low.y)
        );
        float depth = (corner & 4u) != 0u ? extent.depths.y : extent.depths.x;
        vec3 seen = transformRows(motion.instantFromRaster, pictureSpace(at, depth, perspective));
        vec2 place = clamp(projectPicture(seen, perspective), -1.0e8f, 1.0e8f);
        low = min(low, place);
        high = max(high, place);
        depths = vec2(min(depths.x, seen.z), max(depths.y, seen.z));
        isInFront = isInFront || seen.z > 0.0f || !perspective;
    }
    if (lensSample != kNoSample) {
        vec2 alongs = extent.key == kSkyKey ? vec2(0.0f) : alongsBetween(depths);
        vec4 shifts =
            lensShifts(reachOf(InstantMotionsRef(method.motions), lensSample), alongs);
        low += shifts.xy;
        high += shifts.zw;
    }
    if (isInFront) addBox(instant, low - kMarginPx, high + kMarginPx, depths, box);
}

void addDeformed(Extent extent, uint instant, inout SeenBox box) {
    float time = timeOf(InstantMotionsRef(method.motions), instant) - params.rasterTime;
    vec2 a = extent.motionLow * time;
    vec2 b = extent.motionHigh * time;
    vec2 low = vec2(extent.low) + min(a, b);
    vec2 high = vec2(extent.high + 1) + max(a, b);
    widenByLens(instant, extent.depths, low, high);
    addBox(instant, low - kMarginPx, high + kMarginPx, extent.depths, box);
}

void addInstant(
    LayerMotion layer, Extent extent, uint instant, bool perspective, inout SeenBox box
) {
    uint mover = findMover(layer, extent.key);
    if (mover == kDeformedMover)
        addDeformed(extent, instant, box);
    else
        addMotion(
            extent, motionAt(method, has(method, kHasLensPlaces), layer, mover, instant), instant,
            kNoSample, perspective, box
        );
}

/// Adds all instants of a sample, those of its sets, which follow one another.
void addSample(
    LayerMotion layer, Extent extent, uint sample_, bool perspective, inout SeenBox box
) {
    uint first = sample_ * method.setCount;
    uint mover = findMover(layer, extent.key);
    if (!has(method, kHasLensPlaces) || mover == kDeformedMover) {
        for (uint set = 0u; set < method.setCount; ++set)
            addInstant(layer, extent, first + set, perspective, box);
        return;
    }
    InstantMotion motion = InstantMotionTable(layer.motions)
                               .motions[mover * (method.instantCount / kLensSets) + sample_];
    addMotion(extent, motion, first, sample_, perspective, box);
    // Whatever part of the exposure its last set belongs to.
    uint last = first + kLensSets - 1u;
    uint parts = partsPerInstant(method);
    if (partOf(last, parts) != partOf(first, parts))
        addMotion(extent, motion, last, sample_, perspective, box);
}

#endif
