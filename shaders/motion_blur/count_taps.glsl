// SPDX-License-Identifier: MIT
// Counts what a pixel saw: one surface of the raster for the instant of each tap, all with equal weight.
// A surface counts where its own motion brings it to the pixel at that instant. Before it: `params`, and
// textures uColor, uMotionDepth, uDominant and uEntityId.
#ifndef SHUTTER_MOTION_BLUR_COUNT_TAPS_GLSL
#define SHUTTER_MOTION_BLUR_COUNT_TAPS_GLSL

#include "motion_blur/gather_taps.glsl"
#include "motion_blur/motion_arc.glsl"

/// How far from the pixel's centre a surface that hides others may come to lie: half a pixel is exact,
/// and a tenth closes the gaps where neighbours move apart.
const float kReachPx = 0.6f;

/// A surface that one of the layers has at a pixel.
struct Surface {
    vec2 centre; // of the pixel
    uint id;
    vec3 motionDepth;
    vec3 color;
    float nearerDepth; // what is nearer than this lies before it
};

vec2 uvOf(vec2 place) { return place / vec2(params.sizePx); }

vec3 shownMotionDepth(sampler2D image, vec2 uv) {
    vec3 texel = textureLod(image, uv, 0.0f).xyz;
    return vec3(shownMotion(texel.xy, texel.z, params.maxMotionDepth), texel.z);
}

float softExtentAt(float depth) {
    return softExtent(depth, params.softDepthExtent, params.softDepthShare);
}

Surface makeSurface(vec2 centre, uint id, vec3 motionDepth, vec3 color) {
    return Surface(centre, id, motionDepth, color, motionDepth.z - softExtentAt(motionDepth.z));
}

Surface surfaceInRaster(vec2 centre) {
    vec2 uv = uvOf(centre);
    return makeSurface(
        centre, textureLod(uEntityId, uv, 0.0f).x, shownMotionDepth(uMotionDepth, uv),
        textureLod(uColor, uv, 0.0f).rgb
    );
}

/// Where the first tap lies, u.
float placeFirstTap(vec2 centre) {
    float offset = mix(0.5f, interleavedGradientNoise(floor(centre)), params.jitter);
    return tapPosition(0u, offset, countTaps(), params.rasterTime);
}

/// Tap `index`, u.
float placeTap(uint index, float firstTap) {
    return respondToTap(firstTap + float(index) / float(countTaps()));
}

vec2 dominantAt(vec2 centre) {
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    return textureLod(uDominant, tile, 0.0f).xy;
}

/// How far the surface that the raster has at `offset` from the pixel is from it at instant u: pixels,
/// along the axis that is farther.
float distanceAt(vec2 centre, vec2 offset, vec2 motion, float u) {
    vec2 place = floor(centre + offset) + 0.5f - centre;
    vec2 left = abs(place - motion * u);
    return max(left.x, left.y);
}

/// Sets `color` where something before the surface is at the pixel at instant u. The search begins where
/// that would be with the dominant motion, then with half of it; what it finds there gives the next place.
bool findPassing(Surface surface, vec2 dominant, float u, inout vec3 color) {
    for (float share = 1.0f; share > 0.4f; share -= 0.5f) {
        vec2 offset = dominant * (share * u);
        vec2 uv = uvOf(surface.centre + offset);
        vec3 passing = shownMotionDepth(uMotionDepth, uv);
        if (!(passing.z < surface.nearerDepth)) continue;
        if (distanceAt(surface.centre, offset, passing.xy, u) >= kReachPx) {
            offset = passing.xy * u;
            uv = uvOf(surface.centre + offset);
            passing = shownMotionDepth(uMotionDepth, uv);
            if (!(passing.z < surface.nearerDepth) ||
                distanceAt(surface.centre, offset, passing.xy, u) >= kReachPx)
                continue;
        }
        color = textureLod(uColor, uv, 0.0f).rgb;
        return true;
    }
    return false;
}

/// Change of the motion from the pixel to its neighbour, or from the one before it; 0 where neither
/// shows the same surface.
vec2 slopeOfMotion(Surface surface, vec2 toNeighbour) {
    for (float side = 1.0f; side > -2.0f; side -= 2.0f) {
        vec2 uv = uvOf(surface.centre + side * toNeighbour);
        if (textureLod(uEntityId, uv, 0.0f).x != surface.id) continue;
        vec3 there = shownMotionDepth(uMotionDepth, uv);
        if (abs(there.z - surface.motionDepth.z) > softExtentAt(surface.motionDepth.z)) continue;
        return side * (there.xy - surface.motionDepth.xy);
    }
    return vec2(0.0f);
}

Arc findArc(Surface surface) {
    return makeArc(
        surface.motionDepth.xy, slopeOfMotion(surface, vec2(1.0f, 0.0f)),
        slopeOfMotion(surface, vec2(0.0f, 1.0f)), params.rasterTime
    );
}

/// The surface itself at instant u. Where it has gone, its neighbour there is the best guess; where
/// something hides it, the pixel's own colour.
vec3 findOwn(Surface surface, Arc arc, float u) {
    vec2 offset = placeOnArc(arc, u);
    vec2 uv = uvOf(surface.centre + offset);
    vec3 there = shownMotionDepth(uMotionDepth, uv);
    bool isHidden = there.z < surface.nearerDepth &&
                    distanceAt(surface.centre, offset, there.xy, u) >= kReachPx &&
                    textureLod(uEntityId, uv, 0.0f).x != surface.id;
    if (isHidden) return surface.color;
    return textureLod(uColor, uv, 0.0f).rgb;
}

/// The mean over the taps of what the raster shows.
/// \param isFlat no depths within reach differ: nothing lies before anything
vec3 countRaster(vec2 dominant, vec2 centre, bool isFlat) {
    Surface surface = surfaceInRaster(centre);
    vec2 motion = surface.motionDepth.xy;
    float firstTap = placeFirstTap(centre);
    vec3 sum = vec3(0.0f);
    if (dot(motion, motion) < kStillPx * kStillPx) {
        if (isFlat) return surface.color;
        for (uint i = 0u; i < countTaps(); ++i) {
            vec3 color = surface.color;
            findPassing(surface, dominant, placeTap(i, firstTap), color);
            sum += color;
        }
        return sum / float(countTaps());
    }
    // What has its motion is found where the surface itself is looked for.
    vec2 apart = dominant - motion;
    bool isPassed = !isFlat && dot(apart, apart) >= kStillPx * kStillPx;
    Arc arc = findArc(surface);
    for (uint i = 0u; i < countTaps(); ++i) {
        float u = placeTap(i, firstTap);
        vec3 color = vec3(0.0f);
        if (!isPassed || !findPassing(surface, dominant, u, color)) color = findOwn(surface, arc, u);
        sum += color;
    }
    return sum / float(countTaps());
}

#endif
