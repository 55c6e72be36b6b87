// SPDX-License-Identifier: MIT
// Data of crowded tiles (TileCrowd). The including shader has the push constants `params` and
// `method`.
#ifndef SHUTTER_RESOLVED_CROWDS_GLSL
#define SHUTTER_RESOLVED_CROWDS_GLSL

#include "motion_blur/resolved.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CrowdTable {
    TileCrowd tiles[];
};

/// Layers follow one another in the table, up to the last that there is.
uint countLayers() { return has(method, kHasSecondLayer) ? 3u : (has(method, kHasLastLayer) ? 2u : 1u); }

/// Whether any tile may be crowded.
bool mayHaveCrowds() { return (method.crowds.x | method.crowds.y) != 0u; }

/// Whether the tile's lists do not hold all that it sees.
bool isCrowded(uint tile) {
    return mayHaveCrowds() &&
           (CrowdTable(method.crowds).tiles[tile].listed & kTileIsListed) == 0u;
}

/// \param bits of TileCrowd::listed
void noteUnlisted(uint tile, uint bits) {
    atomicAnd(CrowdTable(method.crowds).tiles[tile].listed, ~bits);
}

#endif
