// SPDX-License-Identifier: MIT
// What both stages of a draw of particles share.
#ifndef SHUTTER_PARTICLE_GLSL
#define SHUTTER_PARTICLE_GLSL

#include "particles/particle_shared.h"
#include "common/shutter_response.glsl"
#include "render/environment.glsl"
#include "render/scene_bindings.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ParticleTable {
    ParticleRow rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ParticleEmitterTable {
    ParticleEmitterRow rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ParticleCameras {
    ParticleCamera rows[];
};

layout(push_constant, scalar) uniform Push { ParticleDraw draw; };

layout(constant_id = 0) const bool kReadsInstants = false; // depths of instants hide them

/// Share of the light that is taken before s; a box takes it evenly.
float lightBefore(float s) {
    if ((draw.response.x | draw.response.y) == 0u) return s;
    return cumulativeResponse(ResponseRef(draw.response), s);
}

/// The i-th of the points that cut a span into segments: even ones before the middle, and as many
/// after it.
/// \param span first, middle and last point
float cutSpan(vec3 span, uint segments, uint i) {
    if (segments == 1u) return i == 0u ? span.x : span.z;
    uint half_ = segments / 2u;
    return i <= half_ ? mix(span.x, span.y, float(i) / float(half_))
                      : mix(span.y, span.z, float(i - half_) / float(half_));
}

/// Light that is taken at s per time; a box's is 1.
float lightDensity(float s) {
    if ((draw.response.x | draw.response.y) == 0u) return 1.0f;
    ResponseRef response = ResponseRef(draw.response);
    uint last = 1u;
    while (last < response.value.knotCount - 1u && response.value.knots[last].s < s) ++last;
    ResponseKnot a = response.value.knots[last - 1u];
    ResponseKnot b = response.value.knots[last];
    return mix(a.density, b.density, saturate((s - a.s) / (b.s - a.s)));
}

/// A particle as the picture has it at one time.
struct SeenParticle {
    vec2 placePx;
    float radiusPx;
    float depth;   // metres along the view: the raster's, or with kReadsInstants the instant's own
    float clipW;   // not above FrameConstants::forward.w: behind the camera
};

SeenParticle seeParticle(FrameRef frame, ParticleRow row, ParticleEmitterRow emitter, float s) {
    float age = particleAge(row, emitter, s, draw.rasterTime);
    vec4 place = vec4(particlePlace(row, emitter, age), 1.0f);
    ParticleCameras cameras = ParticleCameras(draw.cameras);
    float time = draw.rasterTime + emitter.cameraShare * (s - draw.rasterTime);
    uint first = 0u;
    while (first + 2u < draw.cameraCount && cameras.rows[first + 1u].s <= time) ++first;
    mat4 camera = cameras.rows[first].clipFromRelWorld;
    vec4 clip = camera * place;
    if (draw.cameraCount > 1u) {
        vec2 ends = vec2(cameras.rows[first].s, cameras.rows[first + 1u].s);
        float share = saturate((time - ends.x) / max(ends.y - ends.x, 1.0e-20f));
        clip = mix(clip, cameras.rows[first + 1u].clipFromRelWorld * place, share);
    }
    SeenParticle seen;
    seen.clipW = clip.w;
    // Before an orthographic camera that reads instants the two are equal: it does not move.
    bool isPerspective = frame.value.pixelFootprint.x > 0.0f;
    seen.depth = kReadsInstants && isPerspective ? clip.w : dot(place.xyz, frame.value.forward.xyz);
    vec2 half_ = 0.5f * frame.value.sizePx;
    float w = max(clip.w, frame.value.forward.w);
    seen.placePx = (clip.xy / w + draw.jitter + 1.0f) * half_;
    float scale = length(vec3(camera[0][0], camera[1][0], camera[2][0]));
    seen.radiusPx = 0.5f * particleSize(row, emitter, age) * scale / w * half_.x;
    return seen;
}

#endif
