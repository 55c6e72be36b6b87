// SPDX-License-Identifier: MIT
// Place of a deforming part at an instant, by its fit.
#ifndef SHUTTER_RESOLVED_PARTS_GLSL
#define SHUTTER_RESOLVED_PARTS_GLSL

#include "common/pixel_way.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/resolved_parts_shared.h"
#include "motion_blur/resolved_shared.h"

/// Index of a tile's first part among those of its layer.
uint firstPartOf(uint tile) { return tile * kPartsPerTile; }

uint keyOfPart(TilePart part) { return part.key & kKeyBits; }

/// The upper left and the lower right border of the part's pixels.
vec4 boxOf(TilePart part) {
    vec2 low = vec2(part.corner & 0xFFFFu, part.corner >> 16u);
    uint sides = part.key >> kPartWidthShift;
    return vec4(low, low + vec2((sides & 15u) + 1u, (sides >> 4u) + 1u));
}

/// An affine map of places in the layer's picture: displacement = shift + change * (place - centre).
struct PartWay {
    vec2 shift;
    vec4 change; // of x by x and y, of y by x and y
    float deviation;
};

vec2 applyChange(vec4 change, vec2 from) {
    return vec2(dot(change.xy, from), dot(change.zw, from));
}

vec4 changeOf(PartVector vector) {
    return vec4(unpackHalf2x16(vector.change.x), unpackHalf2x16(vector.change.y));
}

vec2 vectorAt(PartVector vector, vec2 from) {
    return vector.shift + applyChange(changeOf(vector), from);
}

/// At shutter time s.
PartWay wayAt(TilePart part, float s) {
    float bent = 4.0f * s * (1.0f - s);
    vec2 ends = unpackHalf2x16(part.deviations.x);
    return PartWay(
        mix(part.open.shift, part.close.shift, s) + part.bend.shift * bent,
        mix(changeOf(part.open), changeOf(part.close), s) + changeOf(part.bend) * bent,
        mix(ends.x, ends.y, s) + unpackHalf2x16(part.deviations.y).x * bent
    );
}

/// Least size of the determinant of a map that is inverted.
const float kMinDeterminant = 0.02f;

/// The way back: a place of the instant's picture is centre + back * (place - to) in the layer's.
struct PartBack {
    bool isOfUse; // false: the map has no inverse that is, and places are taken as shifted alone
    mat2 back;
    vec2 centre;
    vec2 to;
};

PartBack invertWay(TilePart part, PartWay way) {
    vec4 a = vec4(1.0f, 0.0f, 0.0f, 1.0f) + way.change;
    float determinant = a.x * a.w - a.y * a.z;
    // Written so that NaN is of no use.
    bool isOfUse = abs(determinant) > kMinDeterminant;
    mat2 back = isOfUse ? mat2(a.w, -a.z, -a.y, a.x) / determinant : mat2(1.0f);
    return PartBack(isOfUse, back, part.centre, part.centre + way.shift);
}

vec2 placeBack(PartBack way, vec2 x) { return way.centre + way.back * (x - way.to); }

/// How much farther off a place is in the layer than where it is seen, on the mean of all directions;
/// at least 1.
float stretchOf(PartBack way) {
    return max(0.7071f * length(vec4(way.back[0], way.back[1])), 1.0f);
}

/// Bounds of where the part's pixels are, by the fit and its deviation.
vec4 boundsOf(TilePart part, PartWay way) {
    vec4 box = boxOf(part);
    vec2 middle = 0.5f * (box.xy + box.zw);
    vec2 half_ = 0.5f * (box.zw - box.xy);
    vec4 spread = abs(vec4(1.0f, 0.0f, 0.0f, 1.0f) + way.change);
    vec2 extent = vec2(dot(spread.xy, half_), dot(spread.zw, half_)) + way.deviation;
    vec2 to = middle + way.shift + applyChange(way.change, middle - part.centre);
    return vec4(to - extent, to + extent);
}

#endif
