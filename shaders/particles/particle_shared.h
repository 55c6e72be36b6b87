// SPDX-License-Identifier: MIT
// Particles (particles::ParticleEmitter) as tables, where each of them is at any time, and the
// share of a span of time in which one covers a pixel: in closed form.
#ifndef SHUTTER_PARTICLE_SHARED_H
#define SHUTTER_PARTICLE_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kParticleAdd = 1u; // adds light and hides nothing
SHUTTER_CONST uint kParticleLit = 2u;
SHUTTER_CONST uint kNoParticleTexture = 0xFFFFFFFFu;
/// Most parts that a picture's exposure is drawn in where particles have textures.
SHUTTER_CONST uint kMaxParticleParts = 8u;
/// Most segments of a streak.
SHUTTER_CONST uint kMaxStreakSegments = 4u;
/// Smaller ones are drawn this large, and fainter: pixels are sampled at their centres.
SHUTTER_CONST float kMinParticleRadiusPx = 1.0f;
/// Most times at which a texture is shown within one part of the exposure.
SHUTTER_CONST uint kMaxPictureTimes = 8u;
/// Pixels between two such times, or a sixth of the radius if that is longer.
SHUTTER_CONST float kPictureStepPx = 1.5f;

struct ParticleRow {
    vec4 placeAge;     // xyz camera-relative space, metres, at birth; w age at the raster instant,
                       // seconds
    vec4 velocityLife; // xyz m/s at birth, w life, seconds
    float angle;       // of its picture at birth, radians
    float spin;        // rad/s
    uint emitter;
    uint padding0;
    vec4 padding1;
};

struct ParticleEmitterRow {
    vec4 gravityDrag; // xyz m/s^2, w 1/s
    vec4 colors[3];   // at birth, half of the life and death: linear, opacity
    vec2 sizes;       // metres across at birth and death
    float softMetres;
    float secondsPerExposure; // the emitter's time from shutter open to close; 0: it is static
    float cameraShare;        // how many times as fast the camera's time runs for it
    uint texture;             // index of the bindless array, or kNoParticleTexture
    float textureTexels;      // its longer side
    uint flags;               // kParticle...
};

/// The camera at one time; between two of them the way in the picture is straight.
struct ParticleCamera {
    mat4 clipFromRelWorld; // without jitter
    float s;               // shutter time; on both sides of a jump nearly the same
};

/// Push constants of a draw of particles.
struct ParticleDraw {
    uvec2 frame;     // address of FrameConstants
    uvec2 rows;      // address of ParticleRow[]
    uvec2 emitters;  // address of ParticleEmitterRow[]
    uvec2 cameras;   // address of ParticleCamera[], at rising times
    uvec2 response;  // address of ResponseTable; 0: a box
    vec2 lightShare; // the part of the exposure's light that is drawn; the two equal: the raster
                     // instant
    vec2 jitter;     // added to the picture's places in clip space
    float rasterTime;
    uint cameraCount; // 1: the camera is static
};

/// (1 - e^-x) / x, and (1 - that) / x. Series near 0, where the differences lose all their digits;
/// after seven terms less than 1e-7 is left at 0.5.
SHUTTER_INLINE vec2 dampedShares(float x) {
    if (x < 0.5f) {
        float second =
            0.5f +
            x * (-1.0f / 6.0f +
                 x * (1.0f / 24.0f +
                      x * (-1.0f / 120.0f +
                           x * (1.0f / 720.0f + x * (-1.0f / 5040.0f + x * (1.0f / 40320.0f))))));
        return vec2(1.0f - x * second, second);
    }
    float first = (1.0f - exp(-x)) / x;
    return vec2(first, (1.0f - first) / x);
}

/// Place of a particle at an age: gravity g and drag k solve v' = g - k v. Camera-relative space,
/// metres.
SHUTTER_INLINE vec3 particlePlace(ParticleRow row, ParticleEmitterRow emitter, float age) {
    vec2 shares = dampedShares(emitter.gravityDrag.w * age);
    return vec3(row.placeAge) + vec3(row.velocityLife) * (age * shares.x) +
           vec3(emitter.gravityDrag) * (age * age * shares.y);
}

/// Metres across.
SHUTTER_INLINE float particleSize(ParticleRow row, ParticleEmitterRow emitter, float age) {
    return mix(emitter.sizes.x, emitter.sizes.y, clamp(age / row.velocityLife.w, 0.0f, 1.0f));
}

SHUTTER_INLINE vec4 particleColor(ParticleRow row, ParticleEmitterRow emitter, float age) {
    float halves = clamp(2.0f * age / row.velocityLife.w, 0.0f, 2.0f);
    return halves < 1.0f ? mix(emitter.colors[0], emitter.colors[1], halves)
                         : mix(emitter.colors[1], emitter.colors[2], halves - 1.0f);
}

/// Radians.
SHUTTER_INLINE float particleAngle(ParticleRow row, float age) {
    return row.angle + row.spin * age;
}

/// Age at shutter time s.
SHUTTER_INLINE float
particleAge(ParticleRow row, ParticleEmitterRow emitter, float s, float rasterTime) {
    return row.placeAge.w + (s - rasterTime) * emitter.secondsPerExposure;
}

/// Shutter times of birth and death; x not below y: it is not alive at any of [first, last].
SHUTTER_INLINE vec2 particleLifetime(
    ParticleRow row, ParticleEmitterRow emitter, float rasterTime, float first, float last
) {
    float age = row.placeAge.w;
    float life = row.velocityLife.w;
    if (emitter.secondsPerExposure <= 0.0f)
        return age >= 0.0f && age < life ? vec2(first, last) : vec2(last, first);
    vec2 ends = vec2(-age, life - age) / emitter.secondsPerExposure + rasterTime;
    return vec2(max(ends.x, first), min(ends.y, last));
}

/// Opacity of a round particle at the square of the distance from its middle in radii.
SHUTTER_INLINE float roundProfile(float distance2) {
    float inside = max(1.0f - distance2, 0.0f);
    return inside * inside;
}

/// The integral of (a - t^2)^2 from 0 to t.
SHUTTER_INLINE float integrateProfile(float a, float t) {
    float t2 = t * t;
    return t * (a * a + t2 * (-2.0f / 3.0f * a + 0.2f * t2));
}

/// Mean opacity at a point while a round particle passes it at a constant speed; y: the share of
/// its way at which it covers it, [0, 1].
///
/// In radii, with u along the way and v across it, (1 - r^2)^2 = (a - t^2)^2 where a = 1 - v^2 and
/// t is the distance along the way, which falls from u to u - length: a polynomial.
/// \param point from the way's start, way: from there to its end, pixels
SHUTTER_INLINE vec2 streakCoverage(vec2 point, vec2 way, float radius) {
    float length_ = sqrt(dot(way, way));
    float lengthRadii = length_ / radius;
    // So short a way changes no bit of a picture; the difference below would lose digits.
    if (lengthRadii < 0.01f) {
        vec2 apart = (point - 0.5f * way) / radius;
        return vec2(roundProfile(dot(apart, apart)), 0.5f);
    }
    vec2 direction = way / length_;
    float u = dot(point, direction) / radius;
    float v = (point.x * direction.y - point.y * direction.x) / radius;
    float a = 1.0f - v * v;
    if (a <= 0.0f)
        return vec2(0.0f, 0.5f);
    float reach = sqrt(a);
    float first = clamp(u, -reach, reach);
    float last = clamp(u - lengthRadii, -reach, reach);
    float sum = integrateProfile(a, first) - integrateProfile(a, last);
    float along = (u - 0.5f * (first + last)) / lengthRadii;
    return vec2(max(sum, 0.0f) / lengthRadii, clamp(along, 0.0f, 1.0f));
}

/// The share of that way, from x to y, at which the particle covers the point that it passes, while
/// its radius goes evenly from `first` to `last`. Not covered: x is not below y.
///
/// Where |u - w t|^2 + v^2 = (first + k t)^2, with u and v as above in pixels and w the way's
/// length.
SHUTTER_INLINE vec2 streakSpan(vec2 point, vec2 way, float first, float last) {
    float length_ = sqrt(dot(way, way));
    vec2 direction = length_ > 0.0f ? way / length_ : vec2(1.0f, 0.0f);
    float u = dot(point, direction);
    float v = point.x * direction.y - point.y * direction.x;
    float k = last - first;
    // a t^2 - 2 b t + c = 0, whose discriminant b^2 - a c is written without large differences.
    float a = (length_ - k) * (length_ + k);
    float b = length_ * u + first * k;
    float c = u * u + v * v - first * first;
    float nearest = length_ * first + k * u;
    float discriminant = nearest * nearest - a * v * v;
    if (discriminant < 0.0f)
        return vec2(0.0f);
    float root = sqrt(discriminant);
    float sum = b < 0.0f ? b - root : b + root;
    if (sum == 0.0f) // neither place nor size changes, or the span is a point
        return vec2(0.0f, c < 0.0f ? 1.0f : 0.0f);
    float one = c / sum;
    float other = a != 0.0f ? sum / a : (sum < 0.0f ? -1.0e30f : 1.0e30f);
    vec2 span = vec2(min(one, other), max(one, other));
    // It changes faster than it moves: of the two the one at which it has a size, and beyond.
    if (a < 0.0f)
        span = k > 0.0f ? vec2(span.y, 1.0f) : vec2(0.0f, span.x);
    return clamp(span, 0.0f, 1.0f);
}

/// Nodes of a sum over a span.
SHUTTER_CONST uint kStreakNodes = 5u;

/// Share of the way, x, and weight, y, of the i-th node of an integral over `span`, whose radius
/// goes from `first` to `last` over the whole way. Gauss's, exact for the profile of a constant
/// radius and colours that change evenly. A size that changes much is integrated over its
/// logarithm: (1 - d^2 / r^2)^2 rises steeply where r is little more than d.
SHUTTER_INLINE vec2 streakNode(vec2 span, float first, float last, uint i) {
    float offset = i == 2u              ? 0.0f
                   : i == 1u || i == 3u ? 0.26923465505284155f
                                        : 0.45308992296933200f;
    float weight = i == 2u              ? 0.28444444444444444f
                   : i == 1u || i == 3u ? 0.23931433524968324f
                                        : 0.11846344252809454f;
    float x = i < 2u ? 0.5f - offset : 0.5f + offset;
    float length_ = span.y - span.x;
    float ratio = (first + (last - first) * span.y) / (first + (last - first) * span.x);
    if (abs(ratio - 1.0f) < 0.05f)
        return vec2(span.x + length_ * x, length_ * weight);
    float scale = length_ / (ratio - 1.0f);
    float grown = pow(ratio, x);
    return vec2(span.x + scale * (grown - 1.0f), weight * scale * grown * log(ratio));
}

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::ParticleRow) == 64);
static_assert(sizeof(shutter::shader::ParticleEmitterRow) == 96);
static_assert(sizeof(shutter::shader::ParticleCamera) == 68);
static_assert(sizeof(shutter::shader::ParticleDraw) == 64);
#endif

#endif
