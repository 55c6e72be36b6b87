// SPDX-License-Identifier: MIT
// What of an alpha-masked caster holds light back.
#version 460
#extension GL_GOOGLE_include_directive : require
#define SHUTTER_UNIFORM_MATERIAL
#include "render/scene_bindings.glsl"
#include "shadows/shadow_shared.h"

layout(constant_id = 0) const uint kAlphaMask = 0u; // 1: texels below the cutoff are dropped

layout(push_constant, scalar) uniform Push { ShadowDraw draw; };

layout(location = 0) in vec4 inUv;
layout(location = 1) in float inAlpha;

void main() {
    if (kAlphaMask == 0u) return;
    FrameRef frame = FrameRef(draw.frame);
    uint index = GeometryTable(frame.value.geometries).rows[draw.geometry].material;
    MaterialRow material = MaterialTable(frame.value.materials).rows[index];
    float alpha = material.baseColor.a * inAlpha;
    TextureRef ref = material.baseColorTexture;
    vec2 own = ref.uvSet == 0u ? inUv.xy : inUv.zw;
    vec2 uv = ref.axes.xy * own.x + ref.axes.zw * own.y + ref.offset;
    vec2 right = dFdx(uv);
    vec2 down = dFdy(uv);
    if (ref.texture != kNoTexture) {
        // As fine as the map, whatever the camera sees of it.
        float area = abs(right.x * down.y - right.y * down.x) * sceneTextureTexels(ref.texture);
        alpha *= sampleSceneTexture(ref.texture, uv, 0.5f * log2(max(area, 1.0e-12f))).a;
    }
    if (alpha < material.emissiveCutoff.a) discard;
}
