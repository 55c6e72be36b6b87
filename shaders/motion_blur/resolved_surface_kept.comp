// SPDX-License-Identifier: MIT
// Packs a raster's depth and entity ids, and copies its colour as it is before the blur.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved_surface.glsl"

layout(binding = 3) uniform sampler2D uColor;
layout(binding = 4, rgba16f) uniform writeonly image2D uKeptColor;

void keepColor(ivec2 pixel) {
    imageStore(uKeptColor, pixel, textureLod(uColor, uvOf(pixel), 0.0f));
}
