// SPDX-License-Identifier: MIT
// Selects which of a listed pixel's samples rays replace, and evaluates the others. The including
// shader has the push constants `params` and `method`, and the constant `kFindsEdges`.
#ifndef SHUTTER_RESOLVED_RAYS_GLSL
#define SHUTTER_RESOLVED_RAYS_GLSL

#include "common/sampling.glsl"
#include "motion_blur/resolved_hidden.glsl"
#include "motion_blur/resolved_lens_color.glsl"

/// Share of the samples of each class that the frame's rays are enough for, the most harmful first.
void shareRays(out float shares[kSampleClasses]) {
    float left = method.rayLimit == kNoRayLimit ? kFarthest : float(method.rayLimit);
    for (uint i = 0u; i < kSampleClasses; ++i) {
        float wanted = float(uCounters.classes[i]);
        shares[i] = wanted > 0.0f ? saturate(left / wanted) : 0.0f;
        left = max(left - wanted, 0.0f);
    }
}

/// The same samples in every frame of the same numbers, spread over the picture.
bool isTraced(ivec2 pixel, uint index, float share) {
    return share >= 1.0f || unitFloat(hashPixel(uvec2(pixel), index, 0u)) < share;
}

/// In the tables.
uint instantOf(PixelSearch search, uint index) { return index * method.setCount + search.set; }

/// Where in the pixel the ray of a sample starts.
vec2 placeOfRay(PixelSearch search, uint index) {
    return kHasEdges ? placeInPixel(search, index) : search.centre;
}

/// Statistics of a pixel's samples.
struct Mean {
    vec3 sum;
    uint known;
    float confusionPx; // the least of those known
};

/// A sample that was looked up.
struct LookedUp {
    bool isKnown;
    bool isTraced; // a ray shall replace it
    vec3 color;
    float confusionPx; // with kHasLens, of the surface found; kFarthest: none
};

LookedUp lookUpAgain(
    inout PixelSearch search, ivec2 pixel, uint index, float shares[kSampleClasses], inout Guesses guesses
) {
    Doubt doubt = kNoDoubt;
    uint instant = instantOf(search, index);
    Seen seen = searchInstant(search, index, instant, guesses, doubt);
    vec3 color = vec3(0.0f);
    bool isKnown = seen.isFound;
    if (seen.isFound) {
        color = colorThroughLens(seen, search, instant);
    } else {
        Substitute substitute = findSubstitute(search, instant);
        isKnown = substitute.distancePx < kFarthest;
        if (isKnown) color = substitute.color;
    }
    float confusionPx = kHasLens && seen.isFound ? confusionOf(seen) : kFarthest;
    bool isChosen = isTraced(pixel, index, shares[classify(seen, color, doubt)]);
    return LookedUp(isKnown, isChosen, color, confusionPx);
}

void addKnown(LookedUp lookedUp, inout Mean mean) {
    if (!lookedUp.isKnown) return;
    mean.sum += lookedUp.color;
    ++mean.known;
    mean.confusionPx = min(mean.confusionPx, lookedUp.confusionPx);
}

/// Adds those of 32 samples that are not traced. \return those that are, a bit each
uint addGuesses(
    inout PixelSearch search, ivec2 pixel, uint first, float shares[kSampleClasses], inout Guesses guesses,
    inout Mean mean
) {
    uint traced = 0u;
    for (uint i = 0u; i < min(params.sampleCount - first, 32u); ++i) {
        LookedUp lookedUp = lookUpAgain(search, pixel, first + i, shares, guesses);
        if (lookedUp.isTraced)
            traced |= 1u << i;
        else
            addKnown(lookedUp, mean);
    }
    return traced;
}

/// Whether any sample of a listed pixel may be traced.
/// \param classes of its samples, a bit each
bool mayTrace(uint classes, float shares[kSampleClasses]) {
    for (uint i = 0u; i < kSampleClasses; ++i)
        if ((classes >> i & 1u) != 0u && shares[i] > 0.0f) return true;
    return false;
}

/// Alpha of a pixel of which samples were traced.
float alphaOf(PixelSearch search, Mean mean) {
    return kHasLens && search.hasOwnSet ? alphaForFilter(method, mean.confusionPx) : 1.0f;
}

#endif
