// SPDX-License-Identifier: MIT
// Where in the picture shading of static surfaces may change from frame to frame.
#ifndef SHUTTER_CHANGING_TILES_GLSL
#define SHUTTER_CHANGING_TILES_GLSL

#include "render/scene_bindings.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ChangingTileTable {
    uint tilesAcross;
    uint words[];
};

/// The word of a tile of kSlotChanging; its bits are the feature's that writes the table.
/// \param pixel of the raster
uint changesOfTile(FrameRef frame, vec2 pixel) {
    if (!hasSlot(frame, kSlotChanging)) return 0u;
    ChangingTileTable tiles = ChangingTileTable(frame.value.slots[kSlotChanging]);
    uvec2 tile = uvec2(pixel) / kChangingTilePx;
    return tiles.words[tile.y * tiles.tilesAcross + tile.x];
}

#endif
