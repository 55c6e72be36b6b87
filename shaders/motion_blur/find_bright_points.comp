// SPDX-License-Identifier: MIT
// Takes bright points out of focus out of the layer, one for a square of pixels at most: few samples would
// show them as separate points. Those that do not suit a disc stay in it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/numeric.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/resolved_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};

#include "motion_blur/bright_points.glsl"

layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform usampler2D uSurface;
layout(binding = 2, rgba16f) uniform writeonly image2D uWithout; // a copy of uColor
layout(binding = 3, scalar) buffer Counts {
    PointHeader uHeader;
    uint uCounts[];
};
layout(binding = 4, scalar) writeonly buffer Points { BrightPoint uPoints[]; };
layout(binding = 5, scalar) buffer Arguments { DispatchArguments uArguments; };
layout(binding = 6, scalar) readonly buffer Regions {
    RegionHeader uRegionHeader;
    uint uRegions[];
};

const uint kThreads = kGroupSize * kGroupSize;
const uint kTilePixels = kPointTilePx * kPointTilePx;
/// Radius of the circle of confusion below which samples lie close enough, pixels.
const float kMinRadiusPx = 3.0f;
/// Maximum of a region's points times the square of their radius, square pixels. A pixel then lies in some
/// 25 discs up to a radius of 90 px; beyond it each region still has one.
const float kMaxRegionArea = 8192.0f;
/// Farthest that a disc reaches from its point in the raster, pixels.
const float kMaxReachPx = 256.0f;
// The surroundings of a point are read in this many directions, at half the radius, between a minimum
// and a maximum distance in pixels.
const uint kDirections = 16u;
const float kMinAroundPx = 4.0f;
const float kMaxAroundPx = 16.0f;
/// Maximum number of these directions that may be bright: a line passes as points, the border of an area
/// does not.
const uint kMaxBrightDirections = 4u;
/// Share of a pixel's luminance that is bright next to it.
const float kBrightShare = 0.25f;
/// Circles of confusion whose radii differ by less count as one depth, pixels.
const float kSameRadiusPx = 0.5f;

shared float sStrengths[kThreads]; // luminance of the point's light; 0: there is none

bool isInPicture(ivec2 pixel) {
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(params.sizePx)));
}

// texelFetch is slow on software devices
vec3 fetchColor(ivec2 pixel) {
    return textureLod(uColor, (vec2(pixel) + 0.5f) / vec2(params.sizePx), 0.0f).rgb;
}

bool isFiniteColor(vec3 color) { return isFinite(color.r) && isFinite(color.g) && isFinite(color.b); }

/// What a pixel is of.
struct Bright {
    vec3 light; // by which it exceeds what is around it; 0: it is none
    vec3 rest;
    uint key;
    float along;
    float confusion; // radius as of Disc
};

/// The mean of the colours around a bright pixel. \return false: too many are bright
bool findAround(ivec2 pixel, float luminance_, float distancePx, out vec3 around) {
    vec3 sum = vec3(0.0f);
    uint dark = 0u;
    uint bright = 0u;
    for (uint i = 0u; i < kDirections; ++i) {
        float angle = 2.0f * kApertureHalfTurn / float(kDirections) * float(i);
        ivec2 at = pixel + ivec2(round(distancePx * vec2(cos(angle), sin(angle))));
        if (!isInPicture(at)) continue;
        vec3 color = fetchColor(at);
        if (isFiniteColor(color) && luminance(color) < kBrightShare * luminance_) {
            sum += color;
            ++dark;
        } else {
            ++bright;
        }
    }
    around = sum / float(max(dark, 1u));
    return dark > 0u && bright <= kMaxBrightDirections;
}

Bright findBright(ivec2 pixel) {
    Bright none = Bright(vec3(0.0f), vec3(0.0f), 0u, 0.0f, 0.0f);
    if (!isInPicture(pixel)) return none;
    vec3 color = fetchColor(pixel);
    float own = luminance(color);
    if (!(own > kMinPointLight) || !isFiniteColor(color)) return none;
    uvec2 surface = textureLod(uSurface, (vec2(pixel) + 0.5f) / vec2(params.sizePx), 0.0f).xy;
    uint key = keyOf(surface);
    float along = key == kSkyKey ? 0.0f : 1.0f / max(uintBitsToFloat(surface.x), kMinDepth);
    vec2 confusion = InstantMotionsRef(method.motions).value.confusion;
    float radius = confusion.x - confusion.y * along;
    if (!(abs(radius) >= kMinRadiusPx)) return none;
    vec3 around;
    if (!findAround(pixel, own, clamp(0.5f * abs(radius), kMinAroundPx, kMaxAroundPx), around)) return none;
    vec3 rest = min(max(around, vec3(0.0f)), color);
    if (!(luminance(color - rest) > kMinPointLight)) return none;
    // Samples of the pixel that another surface covers do not show it.
    float share = 1.0f - 0.25f * float(bitCount(otherSamplesOf(surface)));
    return Bright(share * (color - rest), rest, key, along, radius);
}

bool isSamePoint(Bright a, Bright b) {
    return a.key == b.key && abs(a.confusion - b.confusion) < kSameRadiusPx;
}

ivec2 pixelOf(ivec2 corner, uint i) { return corner + ivec2(i % kPointTilePx, i / kPointTilePx); }

/// The pixels of a square whose luminance may be a point's, one bit each: few squares have any.
uint findCandidates(ivec2 corner) {
    uint candidates = 0u;
    for (uint i = 0u; i < kTilePixels; ++i) {
        // What lies beyond the picture's border repeats it, and is no point.
        bool isBright = luminance(fetchColor(pixelOf(corner, i))) > kMinPointLight;
        candidates |= isBright ? 1u << i : 0u;
    }
    return candidates;
}

/// The strongest of a square's candidates. \return whether there is one
bool findStrongest(ivec2 corner, uint candidates, out Bright strongest) {
    float best = 0.0f;
    for (uint rest = candidates; rest != 0u; rest &= rest - 1u) {
        Bright bright = findBright(pixelOf(corner, uint(findLSB(rest))));
        float strength = luminance(bright.light);
        if (!(strength > best)) continue;
        best = strength;
        strongest = bright;
    }
    return best > 0.0f;
}

/// Where the disc lies over the exposure. \return whether it suits the point at every instant
bool boundDisc(inout BrightPoint point, Aperture aperture) {
    vec2 nearest = vec2(3.0e38f);
    vec2 farthest = vec2(-3.0e38f);
    vec2 radii = vec2(3.0e38f, -3.0e38f); // they have a sign
    for (uint i = 0u; i < params.sampleCount; ++i) {
        Disc disc = discAt(point, i);
        float narrowest = abs(disc.confusion) * min(aperture.squeeze, 1.0f);
        if (!disc.isThere || !(narrowest >= kMinRadiusPx)) return false;
        nearest = min(nearest, disc.at);
        farthest = max(farthest, disc.at);
        radii = vec2(min(radii.x, disc.confusion), max(radii.y, disc.confusion));
    }
    vec2 reach = max(-radii.x, radii.y) * vec2(aperture.squeeze, 1.0f) + 0.5f * point.widthPx + 0.5f;
    point.low = nearest - reach;
    point.high = farthest + reach;
    float travel = max(length(farthest - nearest), radii.y - radii.x);
    point.instants = clamp(uint(min(travel, float(params.sampleCount)) + 0.5f), 1u, params.sampleCount);
    vec2 reached = max(point.at - point.low, point.high - point.at);
    // Written so that NaN is none.
    return reached.x < kMaxReachPx && reached.y < kMaxReachPx;
}

/// \return whether the square has a point that a disc suits
bool makePoint(
    ivec2 corner, uint candidates, Bright strongest, Aperture aperture, out BrightPoint point
) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    point.along = strongest.along;
    point.mover = findMover(motions.value.raster, strongest.key);
    if (point.mover == kNoMover || point.mover == kDeformedMover) return false;
    point.light = vec3(0.0f);
    vec3 moments = vec3(0.0f);
    float weights = 0.0f;
    for (uint rest = candidates; rest != 0u; rest &= rest - 1u) {
        ivec2 pixel = pixelOf(corner, uint(findLSB(rest)));
        Bright bright = findBright(pixel);
        if (bright.light == vec3(0.0f) || !isSamePoint(bright, strongest)) continue;
        vec2 from = vec2(pixel - corner) + 0.5f;
        float weight = luminance(bright.light);
        point.light += bright.light;
        moments += weight * vec3(from, dot(from, from));
        weights += weight;
    }
    moments /= weights;
    point.at = vec2(corner) + moments.xy;
    // Each of 2 x 2 places in a pixel rises over half of it. Variance adds, and is along an axis.
    float variance = max(0.5f * (moments.z - dot(moments.xy, moments.xy)), 0.0f);
    point.widthPx = sqrt(12.0f * variance + 0.25f);
    return boundDisc(point, aperture);
}

/// Replaces the pixels of the point by what is around them.
void takeOut(ivec2 corner, uint candidates, Bright strongest) {
    for (uint rest = candidates; rest != 0u; rest &= rest - 1u) {
        ivec2 pixel = pixelOf(corner, uint(findLSB(rest)));
        Bright bright = findBright(pixel);
        if (bright.light == vec3(0.0f) || !isSamePoint(bright, strongest)) continue;
        imageStore(uWithout, pixel, vec4(bright.rest, kTakenOutAlpha));
    }
}

void main() {
    uint listed = gl_WorkGroupID.y * kRegionRow + gl_WorkGroupID.x;
    if (listed >= uRegionHeader.count) return;
    uint region = uRegions[listed];
    uint across = countRegions(params.sizePx).x;
    uvec2 square = uvec2(region % across, region / across) * kGroupSize + gl_LocalInvocationID.xy;
    ivec2 corner = ivec2(square * kPointTilePx);
    Aperture aperture = apertureOf(InstantMotionsRef(method.motions));
    Bright strongest;
    BrightPoint point;
    uint candidates = findCandidates(corner);
    bool has_ = findStrongest(corner, candidates, strongest) &&
                makePoint(corner, candidates, strongest, aperture, point);
    float strength = has_ ? luminance(point.light) : 0.0f;
    sStrengths[gl_LocalInvocationIndex] = strength;
    barrier();
    uint rank = 0u;
    uint count = 0u;
    for (uint i = 0u; i < kThreads; ++i) {
        float other = sStrengths[i];
        count += other > 0.0f ? 1u : 0u;
        bool isBefore = other > strength || (other == strength && i < gl_LocalInvocationIndex);
        rank += isBefore ? 1u : 0u;
    }
    if (gl_LocalInvocationIndex == 0u) uCounts[region] = min(count, kMaxRegionPoints);
    if (!has_ || rank >= kMaxRegionPoints) return;
    float largest = 0.5f * max(point.high.x - point.low.x, point.high.y - point.low.y);
    if (rank > 0u && float(rank + 1u) * largest * largest > kMaxRegionArea) {
        // It stays samples, and its slot is drawn nowhere.
        point.low = vec2(3.0e38f);
        point.high = vec2(-3.0e38f);
        uPoints[region * kMaxRegionPoints + rank] = point;
        return;
    }
    uPoints[region * kMaxRegionPoints + rank] = point;
    takeOut(corner, candidates, strongest);
    vec2 reach = max(point.at - point.low, point.high - point.at);
    atomicMax(uHeader.reachPx, uint(ceil(max(reach.x, reach.y))));
    uvec2 blocks = (params.sizePx + kGroupSize - 1u) / kGroupSize;
    atomicMax(uArguments.groupsX, blocks.x);
    atomicMax(uArguments.groupsY, blocks.y);
}
