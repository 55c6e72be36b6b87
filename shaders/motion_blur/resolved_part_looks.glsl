// SPDX-License-Identifier: MIT
// Lookups of a block in this frame's raster for deforming entities. Part of resolved_looks.comp.
#ifndef SHUTTER_RESOLVED_PART_LOOKS_GLSL
#define SHUTTER_RESOLVED_PART_LOOKS_GLSL

/// \return whether the part may be seen from the block at the instant
bool isPartShown(ivec2 block, uint key, uint instant) {
    if (kHasLens) return true; // the tile's lists know
    TilePart part = uParts[key & ~kPartBit];
    float s = timeOf(InstantMotionsRef(method.motions), instant);
    vec4 bounds = boundsOf(part, wayAt(part, s));
    const float kReachPx = 0.5f * float(kGroupSize) + kFetchMarginPx;
    return all(greaterThan(centreOf(block), bounds.xy - kReachPx)) &&
           all(lessThan(centreOf(block), bounds.zw + kReachPx));
}

/// Sample positions of a block that sees only the part; isAffine: exact to `uniformMotionPx`.
/// \param off maximum error, pixels
PlaneMap mapPart(TilePart part, float s, ivec2 block, out float off) {
    PartWay way = wayAt(part, s);
    PartBack back = invertWay(part, way);
    off = way.deviation * stretchOf(back);
    PlaneMap map;
    map.isAffine = back.isOfUse && off <= params.uniformMotionPx;
    map.place = placeBack(back, centreOf(block));
    map.perX = back.back[0];
    map.perY = back.back[1];
    map.pxPerAlong = 0.0f;
    return map;
}

/// Greatest distance of two maps of a block.
float mapGap(PlaneMap a, PlaneMap b) {
    return distance(a.place, b.place) +
           kHalfBlockPx * (distance(a.perX, b.perX) + distance(a.perY, b.perY));
}

bool showsKey(ivec2 block, uint key) {
    BlockPlane plane = getPlane(block);
    return plane.mover == kDeformedMover && plane.along == float(key);
}

/// \return whether all sampled pixels belong to the entity
bool isWithin(PlaneMap map, float off, uint key) {
    vec2 reach = kHalfBlockPx * (abs(map.perX) + abs(map.perY)) + kFetchMarginPx + off;
    vec2 first = map.place - reach;
    vec2 last = map.place + reach;
    // Written so that NaN is not within.
    if (!(all(greaterThanEqual(first, vec2(0.0f))) && all(lessThan(last, vec2(params.sizePx)))))
        return false;
    ivec2 low = ivec2(first) / int(kGroupSize);
    ivec2 high = ivec2(last) / int(kGroupSize);
    if (any(greaterThanEqual(high - low, ivec2(kMaxBlocksAcross)))) return false;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            if (!showsKey(ivec2(x, y), key)) return false;
    return true;
}

/// \return whether all that the tile shows of the entity moves as the map
bool movesAs(PlaneMap map, uint tile, uint key, float s, ivec2 block) {
    bool isThere = false;
    for (uint i = 0u; i < kPartsPerTile; ++i) {
        TilePart part = uParts[firstPartOf(tile) + i];
        if (part.key == kNoKey) break;
        if (keyOfPart(part) != key) continue;
        float off;
        PlaneMap own = mapPart(part, s, block, off);
        if (!own.isAffine || off + mapGap(own, map) > params.uniformMotionPx) return false;
        isThere = true;
    }
    return isThere;
}

/// \return whether the sampled pixels move as the map: among them may be parts that no pixel of the
/// block sees, and that hide others which do. Call isWithin() first.
bool seesOneMotion(PlaneMap map, float off, uint key, float s, ivec2 block) {
    vec2 reach = kHalfBlockPx * (abs(map.perX) + abs(map.perY)) + kFetchMarginPx + off;
    uvec2 low = uvec2(map.place - reach) / kCandidateTilePx;
    uvec2 high = uvec2(map.place + reach) / kCandidateTilePx;
    uint tilesAcross = countTiles(params.sizePx).x;
    for (uint y = low.y; y <= high.y; ++y)
        for (uint x = low.x; x <= high.x; ++x)
            if (!movesAs(map, y * tilesAcross + x, key, s, block)) return false;
    return true;
}

/// Sample positions of a block that sees only parts of one entity, which move alike there.
/// \param shown the candidates that the block may see
PlaneMap lookAtParts(ivec2 block, uint tile, uint shown, uint instant, bool isStatic) {
    PlaneMap map;
    map.isAffine = false;
    if (kHasLens) return map; // parts have no plane to be sheared
    uint key = kNoKey;
    float farthest = 0.0f;
    float s = timeOf(InstantMotionsRef(method.motions), instant);
    for (; shown != 0u; shown &= shown - 1u) {
        Candidate candidate = uRaster[tile].candidates[findLSB(shown)];
        bool isFirst = key == kNoKey;
        map.isAffine = map.isAffine || isFirst;
        if (candidate.mover != kDeformedMover) map.isAffine = false;
        if (!map.isAffine) return map;
        TilePart part = uParts[candidate.key & ~kPartBit];
        float off;
        PlaneMap own = mapPart(part, s, block, off);
        if (!isFirst) off += mapGap(own, map);
        if (isFirst) map = own;
        map.isAffine = own.isAffine && off <= params.uniformMotionPx;
        key = keyOfPart(part);
        farthest = max(farthest, off);
    }
    if (!map.isAffine) return map;
    // Static surfaces are not candidates: they may hide parts of movers.
    map.isAffine = (!isStatic || showsKey(block, key)) && isWithin(map, farthest, key) &&
                   seesOneMotion(map, farthest, key, s, block);
    return map;
}

#endif
