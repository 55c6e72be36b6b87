// SPDX-License-Identifier: MIT
// Adds the discs of bright points to the picture: a pixel of a disc sees the point from one place of the
// lens, and a search shows whether something nearer hides it from there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved_shared.h"
#include "motion_blur/motion_blur_shared.h"

const bool kFindsEdges = false;

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};

#include "motion_blur/bright_points.glsl"
#include "motion_blur/resolved_search.glsl"

layout(binding = 23, rgba16f) uniform image2D uPicture;
layout(binding = 24, scalar) readonly buffer Counts {
    PointHeader uHeader;
    uint uCounts[];
};
layout(binding = 25, scalar) readonly buffer Points { BrightPoint uPoints[]; };

/// What is nearer hides the point only if the lens moves it by so much more or less, as a share of the
/// whole lens: pixels.
const float kMinHidingPx = 0.5f;

/// Whether something nearer hides a point from a place of the lens.
/// \param lens displacement in the picture by the place, for lensShift()
/// \param along 1 / depth beyond which nothing hides the point
bool isHidden(PixelSearch pixel, uint sample_, vec4 lens, float along) {
    // Candidates of a crowded tile are not listed.
    if (kHasCrowds && pixel.isCrowded) return false;
    uint instant = sample_ * method.setCount + kMiddleLensSet;
    uint slots = getPart(kRasterLayer, pixel.tile, partOf(instant, pixel.partsPerInstant));
    float s = timeOf(InstantMotionsRef(method.motions), instant);
    for (; slots != 0u; slots &= slots - 1u) {
        uint slot = uint(findLSB(slots));
        Candidate candidate = getCandidate(kRasterLayer, pixel.tile, slot);
        // The others are farther.
        if (candidate.key == kSkyKey || alongOf(uintBitsToFloat(candidate.nearest), true) <= along)
            return false;
        Seen found = Seen(false, kRasterLayer, kNoKey, pixel.x, 0.0f, false, kAnyRange);
        Guess guess = Guess(kNoKey, 0.0f);
        Doubt doubt = kNoDoubt;
        if (isDeformed(candidate.mover))
            searchPart(kRasterLayer, candidate, s, lens, pixel.x, found, doubt);
        else
            searchDepths(
                kRasterLayer, candidate, getRange(pixel, kRasterLayer, slot), candidate.key,
                shearMotion(
                    pinholeMotion(method, pixel.raster, candidate.mover, sample_), candidate.mover, lens
                ),
                true, pixel.x, guess, found, doubt
            );
        if (found.isFound && found.key != kSkyKey && alongOf(found.depth, true) > along) return true;
    }
    return false;
}

/// Light of a point that the pixel sees.
vec3 lightOf(BrightPoint point, PixelSearch pixel, Aperture aperture, float area) {
    float shares = 0.0f;
    for (uint i = 0u; i < point.instants; ++i) {
        uint sample_ = takenInstant(i, point.instants, params.sampleCount);
        Disc disc = discAt(point, sample_);
        vec2 from = pixel.x - disc.at;
        float share = shareOfDisc(aperture, from, disc.confusion, area, point.widthPx);
        if (share == 0.0f) continue;
        LensReach reach = reachOf(InstantMotionsRef(method.motions), sample_);
        vec2 place = from / (reach.inverseFocus - disc.along);
        vec4 lens = vec4(place * reach.inverseFocus, -place);
        if (!isHidden(pixel, sample_, lens, disc.along + kMinHidingPx / reach.radius)) shares += share;
    }
    return point.light * (shares / float(point.instants));
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(at), params.sizePx))) return;
    uvec2 regions = countRegions(params.sizePx);
    ivec2 block = ivec2(gl_WorkGroupID.xy * kGroupSize);
    int reach = int(uHeader.reachPx);
    ivec2 first = max(block - reach, ivec2(0)) / int(kPointRegionPx);
    ivec2 last = min((block + int(kGroupSize) + reach) / int(kPointRegionPx), ivec2(regions) - 1);
    Aperture aperture = apertureOf(InstantMotionsRef(method.motions));
    float area = apertureArea(aperture);
    vec2 centre = vec2(at) + 0.5f;
    PixelSearch pixel;
    bool isBegun = false;
    vec3 sum = vec3(0.0f);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            uint region = uint(y) * regions.x + uint(x);
            for (uint i = 0u; i < uCounts[region]; ++i) {
                BrightPoint point = uPoints[region * kMaxRegionPoints + i];
                if (any(lessThan(centre, point.low - 0.5f)) || any(greaterThan(centre, point.high + 0.5f)))
                    continue;
                if (!isBegun) pixel = beginSearch(at);
                isBegun = true;
                sum += lightOf(point, pixel, aperture, area);
            }
        }
    if (sum == vec3(0.0f)) return;
    vec4 picture = imageLoad(uPicture, at);
    imageStore(uPicture, at, vec4(storableColor(picture.rgb + sum), picture.a));
}
