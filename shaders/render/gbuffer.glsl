// SPDX-License-Identifier: MIT
// The fragment shader of meshes.
#ifndef SHUTTER_GBUFFER_GLSL
#define SHUTTER_GBUFFER_GLSL

#define SHUTTER_UNIFORM_MATERIAL
// Shading slots that the frame has, a bit each: code that looks light up takes three times the
// registers of the rest, whether or not it runs.
layout(constant_id = 3) const uint kSlots = ~0u;
#define SHUTTER_SHADING_SLOTS kSlots
layout(constant_id = 2) const uint kMoves = 1u; // 0: the entity has no motion
#define SHUTTER_LOD_BIAS(frame) (kMoves != 0u ? frame.value.lodBias : frame.value.staticLodBias)
#include "render/lighting.glsl"
#include "render/motion.glsl"
#include "render/fragment_point.glsl"
#include "render/gbuffer_targets.glsl"

layout(constant_id = 0) const uint kAlphaMask = 0u; // 1: pixels below the cutoff are dropped
// 1: alpha is kept for blending; 2: the colour is premultiplied for it
layout(constant_id = 1) const uint kBlend = 0u;

layout(push_constant, scalar) uniform Push { DrawConstants draw; };

layout(location = 5) centroid in vec3 inClipOpen;
layout(location = 6) centroid in vec3 inClipClose;

void main() {
    FrameRef frame = FrameRef(draw.frame);
    MaterialRow material = materialOf(frame, draw.geometry);
    SurfacePoint point = pointOfFragment();
    vec3 viewDirection = viewDirectionTo(frame, point.relWorldPosition);
    Surface surface = evaluateSurface(frame, material, point, viewDirection);
#ifdef SHUTTER_MASKS_SAMPLES
    uint covered = surface.passing & uint(gl_SampleMaskIn[0]);
    if (covered == 0u) discard;
    gl_SampleMask[0] = int(covered);
#else
    if (kAlphaMask != 0u && surface.alpha < material.emissiveCutoff.a) discard;
#endif

    vec3 color = shadeSurface(
        frame, material, surface, point.relWorldPosition, viewDirection, lightsAtRaster(frame),
        lightAccessAt(frame, draw.entity, gl_FragCoord.xy)
    );
    vec4 blended = vec4(color, kBlend != 0u ? saturate(surface.alpha) : 1.0f);
    if (kBlend == 2u) {
        BlendShares shares = blendSharesOf(material.flags, surface.alpha);
        blended = vec4(color * shares.light, shares.opacity);
    }
    vec2 motion = vec2(0.0f);
    if (kMoves != 0u) {
        // x, y, w of the raster clip position; 1 / gl_FragCoord.w is w.
        float w = 1.0f / gl_FragCoord.w;
        vec3 visible = vec3((gl_FragCoord.xy / frame.value.sizePx * 2.0f - 1.0f) * w, w);
        motion = motionFromClip(
            inClipOpen, inClipClose, visible, frame.value.forward.w, frame.value.sizePx
        );
    }
    float depth = dot(point.relWorldPosition, frame.value.forward.xyz);
    writeTargets(blended, surface.normal, motion, depth, draw.entity);
}

#endif
