// SPDX-License-Identifier: MIT
// Packs a raster's depth and entity ids.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved_surface.glsl"

void keepColor(ivec2 pixel) {}
