// SPDX-License-Identifier: MIT
// Where in the picture the shadows of movers may fall.
#ifndef SHUTTER_SHADOW_TILES_GLSL
#define SHUTTER_SHADOW_TILES_GLSL

#include "render/scene_bindings.glsl"
#include "render/shadow_shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ShadowRef {
    ShadowConstants value;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShadowTileTable {
    uint movers[];
};

/// The movers whose shadows may fall into a tile of the raster: boxes around them touch it.
/// \param pixel of the raster
uint moversOfTile(FrameRef frame, vec2 pixel) {
    uvec2 address = frame.value.shadows;
    if ((address.x | address.y) == 0u) return 0u;
    ShadowRef shadows = ShadowRef(address);
    uvec2 tile = uvec2(pixel) / kShadowTilePx;
    return ShadowTileTable(shadows.value.tiles).movers[tile.y * shadows.value.tilesAcross + tile.x];
}

#endif
