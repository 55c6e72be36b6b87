// SPDX-License-Identifier: MIT
// Morph targets, waves and linear blend skinning of one vertex (glTF 2.0, 3.7.2.2 and 3.7.3.3):
// first morphed, then displaced by waves, then skinned.
#ifndef SHUTTER_DEFORM_GLSL
#define SHUTTER_DEFORM_GLSL

#include "common/numeric.glsl"
#include "render/deform_shared.h"
#include "render/timed_scene_shared.h"

SHUTTER_SHADER_BEGIN

/// What of a vertex its deformation changes.
struct DeformedVertex {
    vec3 position; // object space
    vec3 normal;   // unit, or 0 where there is none
    vec3 tangent;  // likewise
};

/// 0 for vectors without a direction: zero, NaN and infinity.
SHUTTER_INLINE vec3 unitOrZero(vec3 v) {
    // Scaled first: squares of small and large numbers leave single precision.
    float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (!(largest > 0.0f) || !isFinite(largest)) return vec3(0.0f);
    vec3 scaled = v / largest;
    float size = length(scaled);
    // NaN of one component hides from max.
    return isFinite(size) ? scaled / size : vec3(0.0f);
}

/// Normal and tangent are left as long as they come; finishVertex() makes them unit.
SHUTTER_INLINE DeformedVertex morphVertex(DeformedVertex vertex, MorphDelta delta, float weight) {
    DeformedVertex result = vertex;
    result.position += weight * vec3(delta.position);
    result.normal += weight * vec3(delta.normal);
    result.tangent += weight * vec3(delta.tangent);
    return result;
}

/// The share of its waves that a vertex follows, and how it changes with its place.
struct WaveShareAt {
    float share;   // [0, 1]
    vec3 gradient; // per metre; 0 for a share of colour, whose change over the surface is unknown
};

/// \param color the vertex's
SHUTTER_INLINE WaveShareAt findWaveShare(DeformJob job, vec3 position, vec4 color) {
    WaveShareAt result;
    result.share = 1.0f;
    result.gradient = vec3(0.0f);
    if (job.waveShare == kWaveShareAll) return result;
    bool byHeight = job.waveShare == kWaveShareHeight;
    float linear_ = byHeight ? dot(vec3(job.waveHeight), position) + job.waveHeight.w
                             : color[job.waveShare - kWaveShareColor];
    // Written so that NaN is held.
    if (!(linear_ > 0.0f)) {
        result.share = 0.0f;
        return result;
    }
    if (linear_ >= 1.0f) return result;
    result.share = pow(linear_, job.waveExponent);
    if (byHeight)
        result.gradient =
            job.waveExponent * (result.share / linear_) * vec3(job.waveHeight);
    return result;
}

/// What waves add to a vertex, and the change of that with its place.
struct WaveSum {
    vec3 displacement;
    vec3 rows[3]; // of the Jacobian
};

SHUTTER_INLINE WaveSum noWave() {
    WaveSum zero;
    zero.displacement = vec3(0.0f);
    for (int i = 0; i < 3; ++i) zero.rows[i] = vec3(0.0f);
    return zero;
}

/// \param position of the vertex before any wave
SHUTTER_INLINE WaveSum addWave(WaveSum sum, WaveRow wave, WaveShareAt at, vec3 position) {
    const float kTurn = 6.28318530718f;
    float phase = wave.displacement.w - dot(vec3(wave.waveVector), position);
    // Sines of large angles are imprecise.
    phase -= kTurn * floor(phase / kTurn + 0.5f);
    float height = sin(phase);
    vec3 gradient = height * at.gradient - (at.share * cos(phase)) * vec3(wave.waveVector);
    WaveSum result = sum;
    result.displacement += (at.share * height) * vec3(wave.displacement);
    for (int i = 0; i < 3; ++i) result.rows[i] += wave.displacement[i] * gradient;
    return result;
}

/// Normal and tangent turned by a linear map with these rows. The normal goes with the cofactor
/// matrix: right for any scale.
SHUTTER_INLINE DeformedVertex turnDirections(DeformedVertex vertex, vec3 x, vec3 y, vec3 z) {
    DeformedVertex result = vertex;
    result.normal = vec3(
        dot(cross(y, z), vertex.normal), dot(cross(z, x), vertex.normal), dot(cross(x, y), vertex.normal)
    );
    result.tangent = vec3(dot(x, vertex.tangent), dot(y, vertex.tangent), dot(z, vertex.tangent));
    return result;
}

SHUTTER_INLINE DeformedVertex waveVertex(DeformedVertex vertex, WaveSum sum) {
    DeformedVertex result = turnDirections(
        vertex,
        vec3(1.0f, 0.0f, 0.0f) + sum.rows[0],
        vec3(0.0f, 1.0f, 0.0f) + sum.rows[1],
        vec3(0.0f, 0.0f, 1.0f) + sum.rows[2]
    );
    result.position += sum.displacement;
    return result;
}

/// The sum of a vertex's joint matrices so far, and one more.
SHUTTER_INLINE MotionKey addJoint(MotionKey sum, MotionKey objectFromBind, float weight) {
    MotionKey result = sum;
    for (int i = 0; i < 3; ++i) result.rows[i] += weight * objectFromBind.rows[i];
    return result;
}

SHUTTER_INLINE MotionKey noJoint() {
    MotionKey zero;
    for (int i = 0; i < 3; ++i) zero.rows[i] = vec4(0.0f);
    return zero;
}

/// Where the matrix mirrors, the normal points to the back of the winding, which is turned round too
/// (EntityRow::handedness rights both).
SHUTTER_INLINE DeformedVertex skinVertex(DeformedVertex vertex, MotionKey blended) {
    vec3 x = vec3(blended.rows[0]);
    vec3 y = vec3(blended.rows[1]);
    vec3 z = vec3(blended.rows[2]);
    vec4 p = vec4(vertex.position, 1.0f);
    DeformedVertex result = turnDirections(vertex, x, y, z);
    result.position = vec3(dot(blended.rows[0], p), dot(blended.rows[1], p), dot(blended.rows[2], p));
    return result;
}

/// Normalises directions, and makes the position valid for builders of acceleration structures: one
/// that is not finite becomes the origin.
SHUTTER_INLINE DeformedVertex finishVertex(DeformedVertex vertex) {
    DeformedVertex result = vertex;
    if (!isFinite(vertex.position.x) || !isFinite(vertex.position.y) || !isFinite(vertex.position.z))
        result.position = vec3(0.0f);
    result.normal = unitOrZero(vertex.normal);
    result.tangent = unitOrZero(vertex.tangent);
    return result;
}

/// Which joint a group's entry 0 ... 3 names.
SHUTTER_INLINE uint unpackJoint(uvec2 packed_, uint entry) {
    uint pair = entry < 2u ? packed_.x : packed_.y;
    return (entry & 1u) == 0u ? pair & 0xFFFFu : pair >> 16u;
}

SHUTTER_SHADER_END

#endif
