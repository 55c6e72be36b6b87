// SPDX-License-Identifier: MIT
// A blended surface at an instant of the exposure, composited under the surfaces already drawn for
// that instant: nearest first. Alpha of both targets is the transmittance so far.
#version 460
#extension GL_GOOGLE_include_directive : require
#define SHUTTER_UNIFORM_MATERIAL
#include "common/instant_surfaces.glsl"
#include "common/picture_space.glsl"
#include "glass/blended_layer_shared.h"
#include "render/lighting.glsl"
#include "render/fragment_point.glsl"

layout(constant_id = 0) const bool kReadsInstants = false; // depths of instants hide it

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LayerInstantRef {
    LayerInstant value;
};
layout(push_constant, scalar) uniform Push { LayerDraw draw; };

layout(binding = 0) uniform sampler2D uMotionDepth; // of the raster
layout(binding = 1, scalar) readonly buffer Surfaces {
    InstantSurfaces uHead;
    uint uWords[];
};

layout(location = 0) out vec4 outColor;   // premultiplied
layout(location = 1) out vec4 outOpacity; // in red

/// \param point picture space of the tested point
float depthOfRaster(vec3 point) {
    vec2 at = projectPicture(point, draw.isPerspective != 0u);
    ivec2 size = textureSize(uMotionDepth, 0);
    // Surfaces outside of the picture are unknown.
    if (any(lessThan(at, vec2(0.0f))) || any(greaterThanEqual(at, vec2(size)))) return kSkyDepth;
    return texelFetch(uMotionDepth, ivec2(at), 0).z;
}

float depthOfInstant() {
    uint word = surfaceDepthWord(uHead, draw.index, uvec2(gl_FragCoord.xy));
    vec2 depths = unpackHalf2x16(uWords[word]);
    return (draw.index & 1u) == 0u ? depths.x : depths.y;
}

void main() {
    FrameRef frame = FrameRef(draw.frame);
    LayerInstant instant = LayerInstantRef(draw.instant).value;
    MaterialRow material = materialOf(frame, draw.geometry);
    SurfacePoint point = pointOfFragment();
    vec3 tested = transformRows(instant.testFromRelWorld, vec4(inRelWorldPosition, 1.0f));
    float hiding = kReadsInstants ? depthOfInstant() : depthOfRaster(tested);
    if (tested.z > hiding * (1.0f + kLayerDepthSlack)) discard;

    vec3 viewDirection = viewDirectionTo(frame, inRelWorldPosition);
    Surface surface = evaluateSurface(frame, material, point, viewDirection);
    // Tables of shading go by the raster's picture.
    vec4 clip = frame.value.clipFromRelWorld * vec4(inRelWorldPosition, 1.0f);
    vec2 inRaster = (clip.xy / max(clip.w, kMinDepth) * 0.5f + 0.5f) * frame.value.sizePx;
    inRaster = clamp(inRaster, vec2(0.0f), frame.value.sizePx - 1.0f);
    vec3 color = shadeSurface(
        frame, material, surface, inRelWorldPosition, viewDirection, lightsAtRaster(frame),
        lightAccessAt(frame, draw.entity, inRaster)
    );
    BlendShares shares = blendSharesOf(material.flags, surface.alpha);
    outColor = vec4(color * (shares.light * instant.weight), shares.opacity);
    outOpacity = vec4(shares.opacity * instant.weight, 0.0f, 0.0f, shares.opacity);
}
