// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "render/shape_ways_shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer RowRef {
    ShapeWayRow value;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Places {
    vec4 values[];
};
layout(push_constant, scalar) uniform Push { ShapeWayDraw draw; };

layout(location = 0) out vec4 outRaster;
layout(location = 1) out vec3 outOpen;
layout(location = 2) out vec3 outMiddle;
layout(location = 3) out vec3 outClose;

vec4 placeAt(uvec2 positions, uint stride) {
    return vec4(Places(positions).values[gl_VertexIndex * stride].xyz, 1.0f);
}

vec3 apply(vec4 rows[3], vec4 place) {
    return vec3(dot(rows[0], place), dot(rows[1], place), dot(rows[2], place));
}

void main() {
    ShapeWayRow row = RowRef(draw.row).value;
    vec4 raster = placeAt(draw.rasterPositions, draw.rasterStride);
    gl_Position = row.clipFromObject * raster;
    outRaster = vec4(
        dot(row.raster[0], raster), dot(row.raster[1], raster), dot(row.raster[2], raster),
        dot(row.raster[3], raster)
    );
    outOpen = apply(row.open, placeAt(draw.openPositions, draw.exposureStride));
    outMiddle = apply(row.middle, placeAt(draw.middlePositions, draw.exposureStride));
    outClose = apply(row.close, placeAt(draw.closePositions, draw.exposureStride));
}
