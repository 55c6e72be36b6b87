// SPDX-License-Identifier: MIT
// Searches the sample of a pixel on a deforming part (resolved_parts_shared.h). The part's fit
// gives the first guess; per-pixel motion decides. Part of resolved_search.glsl.
#ifndef SHUTTER_RESOLVED_PART_SEARCH_GLSL
#define SHUTTER_RESOLVED_PART_SEARCH_GLSL

/// Deviation from which a part may be seen at several places at once, pixels.
const float kWideDeviationPx = 1.0f;
/// Maximum distance from the fit's estimate within which a part is searched, pixels.
const float kMaxDeviationReachPx = 8.0f;

/// Newton's steps from one place: the fit leads to within a pixel or so, and more gain nothing.
const uint kPartSteps = 2u;

/// \return whether it is known where the layer's pixel is seen at shutter time s
bool findDisplacement(uint layer, ivec2 texel, float s, out vec2 displacement) {
    vec2 uv = uvOf(vec2(texel) + 0.5f);
    displacement = vec2(0.0f);
    if (!has(method, kHasWays)) {
        vec2 motion = textureLod(uMotionDepth, uv, 0.0f).xy;
        displacement = motion * (s - params.rasterTime);
        return true;
    }
    uvec2 words = layer == kRasterLayer ? textureLod(uWays, uv, 0.0f).xy
                                        : textureLod(uLastWays, uv, 0.0f).xy;
    if (isSecond(layer)) words = textureLod(uSecondWays, uv, 0.0f).xy;
    if (words.x == kNoWay) return false;
    displacement = displacementAt(unpackWay(words), s);
    return true;
}

/// Data shared by the searches for one part at one instant.
struct PartSearch {
    uint layer;
    uint key;
    float s;   // shutter time
    vec4 lens; // lensOf(), with kHasLens
    vec2 x;
    mat2 back; // how places in the layer move with the place that they are seen at
};

/// By Newton's steps from one place, each on the motion of the pixel there: stores the pixel's
/// sample on the entity, if there is one.
void searchFrom(PartSearch search, vec2 at, inout Seen found, inout Doubt doubt) {
    [[dont_unroll]] for (uint step_ = 0u; step_ < kPartSteps; ++step_) {
        if (!isInside(at)) return;
        ivec2 texel = ivec2(at);
        Probe surface = fetchSurfaceAt(search.layer, at);
        if (surface.key != search.key) {
            noteMiss(search.layer, search.key, kAnyRange, at, doubt);
            return;
        }
        vec2 displacement;
        if (!findDisplacement(search.layer, texel, search.s, displacement)) return;
        if (kHasLens) displacement += lensShift(search.lens, surface.depth);
        vec2 centre = vec2(texel) + 0.5f;
        vec2 next = centre + search.back * (search.x - centre - displacement);
        float way = distance(next, at);
        at = next;
        // A step from the same pixel would end at the same place.
        bool isThere = isInside(at) && ivec2(at) == texel;
        if (!isThere && way > kArrivedPx && step_ + 1u < kPartSteps) continue;
        if ((!isThere && way > kTolerancePx) || !isInside(at)) return;
        if (kHasEdges || !isThere) surface = fetchSurfaceAt(search.layer, at);
        if (surface.key != search.key) {
            noteMiss(search.layer, search.key, kAnyRange, at, doubt);
            return;
        }
        bool inner = isInner(surface.innerCorners, at - floor(at));
        Seen seen = Seen(true, search.layer, search.key, at, surface.depth, inner, kAnyRange);
        keepNearer(found, seen, search.x);
        return;
    }
}

/// Searches the pixel's sample on a part.
/// \param candidate with a part
/// \param s shutter time
/// \param lens lensOf(), with kHasLens
void searchPart(
    uint layer, Candidate candidate, float s, vec4 lens, vec2 x, inout Seen found, inout Doubt doubt
) {
    TilePart part = getTilePart(layer, candidate.key & ~kPartBit);
    PartWay way = wayAt(part, s);
    PartBack back = invertWay(part, way);
    vec2 at = placeBack(back, x);
    float reach = min(way.deviation * stretchOf(back), kMaxDeviationReachPx);
    if (kHasLens) {
        vec2 nearest = lensShift(lens, uintBitsToFloat(candidate.nearest));
        vec2 farthest = lensShift(lens, uintBitsToFloat(~candidate.farthestInverted));
        at = placeBack(back, x - 0.5f * (nearest + farthest));
        reach += 0.5f * distance(nearest, farthest) * stretchOf(back);
    }
    vec4 box = boxOf(part);
    if (any(lessThan(at, box.xy - reach - 1.0f)) || any(greaterThan(at, box.zw + reach + 1.0f)))
        return;
    PartSearch search = PartSearch(layer, keyOfPart(part), s, lens, x, back.back);
    bool isWide = way.deviation > kWideDeviationPx;
    // From the place itself and, if the part may be seen at several places, from the nearest one in
    // it: the nearer hit hides the other, as with one leg in front of the other. One loop, since
    // compilers inline every call.
    uint count = isWide ? 2u : 1u;
    [[dont_unroll]] for (uint i = 0u; i < count; ++i) {
        vec2 from = i == 0u ? at : clamp(at, box.xy + 0.5f, box.zw - 0.5f);
        if (i == 1u && from == at) return;
        searchFrom(search, from, found, doubt);
    }
}

#endif
