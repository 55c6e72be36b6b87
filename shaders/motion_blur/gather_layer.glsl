// SPDX-License-Identifier: MIT
// The gather over one layer. Before it: `params`, `method` (GatherParams), and textures uColor, uMotionDepth and uDominant.
#ifndef SHUTTER_MOTION_BLUR_GATHER_LAYER_GLSL
#define SHUTTER_MOTION_BLUR_GATHER_LAYER_GLSL

#include "motion_blur/gather_taps.glsl"

struct Gathered {
    vec3 sum;
    float weight;
};

/// A pixel that gathers the surfaces that pass over it.
struct Target {
    float depth;
    float speed;
    float firstTap;      // u
    float perTap;        // u from one tap to the next
    vec2 perReach;       // 1 / length of its smear to the side of u >= 0, to the other
    float perSoftExtent; // 1 / SOFT_Z_EXTENT
};

Target makeTarget(vec3 motionDepth, vec2 centre) {
    vec2 motion = shownMotion(motionDepth.xy, motionDepth.z, params.maxMotionDepth);
    float noise = interleavedGradientNoise(floor(centre));
    float speed = length(motion);
    float offset = mix(0.5f, noise, params.jitter);
    return Target(
        motionDepth.z, speed, tapPosition(0u, offset, countTaps(), params.rasterTime),
        1.0f / float(countTaps()),
        vec2(
            smearRatio(1.0f, speed * params.rasterTime),
            smearRatio(1.0f, speed * (1.0f - params.rasterTime))
        ),
        1.0f / softExtent(motionDepth.z, params.softDepthExtent, params.softDepthShare)
    );
}

/// Tap `index`, u.
float placeTap(uint index, Target target) {
    float even = target.firstTap + float(index) * target.perTap; // tapPosition()
    return respondToTap(even);
}

/// \param motionDepth of the tap
/// \param range length of the dominant motion
float weighTap(vec3 motionDepth, float u, float range, Target target) {
    vec2 motion = shownMotion(motionDepth.xy, motionDepth.z, params.maxMotionDepth);
    // A smear reaches this share of its length to u's side of the raster instant.
    float reach = u >= 0.0f ? params.rasterTime : 1.0f - params.rasterTime;
    float distancePx = range * abs(u);
    return sampleWeightAt(
        (target.depth - motionDepth.z) * target.perSoftExtent,
        smearRatio(distancePx, length(motion) * reach),
        distancePx * (u >= 0.0f ? target.perReach.x : target.perReach.y),
        method.foregroundMagnification
    );
}

vec2 dominantAt(sampler2D dominant, vec2 centre) {
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    return textureLod(dominant, tile, 0.0f).xy;
}

/// Over the raster's layer.
Gathered gatherRaster(vec2 dominant, vec2 centre) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec2 uv = centre * pixelsToUv;
    Target target = makeTarget(textureLod(uMotionDepth, uv, 0.0f).xyz, centre);
    Gathered result;
    result.weight = centreWeight(target.speed);
    result.sum = textureLod(uColor, uv, 0.0f).rgb * result.weight;
    float range = length(dominant);
    for (uint i = 0u; i < countTaps(); ++i) {
        float u = placeTap(i, target);
        vec2 at = (centre + dominant * u) * pixelsToUv;
        float weight = weighTap(textureLod(uMotionDepth, at, 0.0f).xyz, u, range, target);
        result.sum += textureLod(uColor, at, 0.0f).rgb * weight;
        result.weight += weight;
    }
    return result;
}

#endif
