// SPDX-License-Identifier: MIT
// The scene as shaders reach it: tables by address, textures as set 1.
#ifndef SHUTTER_SCENE_BINDINGS_GLSL
#define SHUTTER_SCENE_BINDINGS_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require

#include "render/scene_shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer FrameRef {
    FrameConstants value;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer EntityTable {
    EntityRow rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer MotionTable {
    EntityMotion rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer GeometryTable {
    Geometry rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer MaterialTable {
    MaterialRow rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LightTable {
    LightRow rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer VertexArray {
    Vertex values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PositionArray {
    vec4 values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer IndexArray {
    uint values[];
};

bool hasSlot(FrameRef frame, uint slot) {
    uvec2 address = frame.value.slots[slot];
    return (address.x | address.y) != 0u;
}

layout(set = 1, binding = 0) uniform sampler2D uTextures[];

// A draw has one material, rays of a group meet many: the draw's shaders define
// SHUTTER_UNIFORM_MATERIAL before including this, and the index needs no per-lane loop.
#ifdef SHUTTER_UNIFORM_MATERIAL
#define SHUTTER_TEXTURE(index) uTextures[index]
#else
#define SHUTTER_TEXTURE(index) uTextures[nonuniformEXT(index)]
#endif

vec4 sampleSceneTexture(uint texture_, vec2 uv, float level) {
    return textureLod(SHUTTER_TEXTURE(texture_), uv, level);
}

float sceneTextureTexels(uint texture_) {
    ivec2 size = textureSize(SHUTTER_TEXTURE(texture_), 0);
    return float(size.x) * float(size.y);
}

vec4 unpackColor(uvec2 packed_) {
    return vec4(unpackHalf2x16(packed_.x), unpackHalf2x16(packed_.y));
}

#endif
