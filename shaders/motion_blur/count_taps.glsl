// SPDX-License-Identifier: MIT
// Counts what a pixel saw: one surface for the instant of each tap, all with equal weight. A surface
// counts where its own motion brings it to the pixel at that instant. Before it: `params`.
#ifndef SHUTTER_MOTION_BLUR_COUNT_TAPS_GLSL
#define SHUTTER_MOTION_BLUR_COUNT_TAPS_GLSL

#include "motion_blur/gather_taps.glsl"

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

/// Where the first tap lies, u.
float placeFirstTap(vec2 centre) {
    float offset = mix(0.5f, interleavedGradientNoise(floor(centre)), params.jitter);
    return tapPosition(0u, offset, countTaps(), params.rasterTime);
}

/// Tap `index`, u.
float placeTap(uint index, float firstTap) {
    return respondToTap(firstTap + float(index) / float(countTaps()));
}

#endif
