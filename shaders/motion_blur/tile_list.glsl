// SPDX-License-Identifier: MIT
// The list of tiles with masked pixels, read. Define SHUTTER_TILE_LIST_BINDING.
#ifndef SHUTTER_MOTION_BLUR_TILE_LIST_GLSL
#define SHUTTER_MOTION_BLUR_TILE_LIST_GLSL

#include "motion_blur/motion_blur_shared.h"

layout(binding = SHUTTER_TILE_LIST_BINDING, scalar) readonly buffer Tiles {
    TileHeader header;
    uint words[]; // listed tiles, then a flag for each tile of the picture
} uTileList;

#endif
