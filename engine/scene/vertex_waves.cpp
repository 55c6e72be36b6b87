// SPDX-License-Identifier: MIT
#include "engine/scene/vertex_waves.h"

#include "engine/math/bounds.h"
#include "engine/math/transform.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shutter::scene {

namespace {

using math::dmat3;
using math::dvec3;
using math::dvec4;
using math::isWithin;

/// Where single precision, in which vertices are displaced, has no fraction of a radian left.
constexpr double kMaxWaveRate = 1.0e6;
constexpr double kMaxMetres = 1.0e6;
constexpr double kMaxExponent = 16.0;

core::Status validateWave(const VertexWave& wave, size_t index) {
    if (!isWithin(wave.displacement, kMaxMetres))
        return core::makeError("waves[{}].displacement is not within 1e6 metres", index);
    if (!isWithin(wave.waveVector, kMaxWaveRate))
        return core::makeError("waves[{}].waveVector is not within 1e6 radians per metre", index);
    if (!(wave.hertz >= 0.0 && wave.hertz <= kMaxWaveRate))
        return core::makeError("waves[{}].hertz is {}, not in [0, 1e6]", index, wave.hertz);
    if (!(std::abs(wave.phase) <= kMaxWaveRate))
        return core::makeError("waves[{}].phase is {}, not in [-1e6, 1e6]", index, wave.phase);
    return {};
}

core::Status validateShares(const VertexWaves& waves) {
    if (!(waves.exponent >= 1.0 && waves.exponent <= kMaxExponent))
        return core::makeError("the waves' exponent is {}, not in [1, 16]", waves.exponent);
    if (waves.share == WaveShare::Color && waves.channel > 3)
        return core::makeError("the waves' channel is {}, not in 0 ... 3", waves.channel);
    if (waves.share != WaveShare::Height)
        return {};
    if (!isWithin(waves.axis, kMaxMetres) || !(glm::length(waves.axis) > 0.0))
        return core::makeError("the waves' axis has no direction");
    if (!(std::abs(waves.heldAt) <= kMaxMetres) || !(std::abs(waves.freeAt) <= kMaxMetres) ||
        waves.heldAt == waves.freeAt)
        return core::makeError(
            "the waves' heights are held at {} and free at {}: they must differ and be finite",
            waves.heldAt,
            waves.freeAt
        );
    return {};
}

WaveShares makeShares(const VertexWaves& waves) {
    WaveShares shares{waves.share, dvec4(0.0), waves.channel, waves.exponent};
    if (waves.share == WaveShare::Height) {
        const double height = waves.freeAt - waves.heldAt;
        shares.height = dvec4(glm::normalize(waves.axis) / height, -waves.heldAt / height);
    }
    return shares;
}

} // namespace

core::Status validateWaves(const VertexWaves& waves) {
    if (waves.waves.size() > kMaxVertexWaves)
        return core::makeError("there are {} waves, above {}", waves.waves.size(), kMaxVertexWaves);
    if (!isWithin(waves.lean, kMaxMetres))
        return core::makeError("the waves' lean is not within 1e6 metres");
    for (size_t i = 0; i < waves.waves.size(); ++i)
        SHUTTER_TRY(validateWave(waves.waves[i], i));
    return validateShares(waves);
}

bool isRunning(const VertexWaves& waves) {
    return std::any_of(waves.waves.begin(), waves.waves.end(), [](const VertexWave& wave) {
        return wave.hertz != 0.0 && wave.displacement != dvec3(0.0);
    });
}

WavePose poseWaves(const VertexWaves& waves, double seconds, const math::dmat4& worldFromObject) {
    const dmat3 axes(worldFromObject);
    const dvec3 origin(worldFromObject[3]);
    const double determinant = glm::determinant(axes);
    // Written so that NaN is none.
    const bool hasInverse = std::abs(determinant) > 0.0 && math::isFinite(worldFromObject);
    const dmat3 objectFromWorld = hasInverse ? glm::inverse(axes) : dmat3(0.0);
    constexpr double kTurn = 2.0 * std::numbers::pi;
    WavePose pose;
    pose.shares = makeShares(waves);
    // A crest that stays: sin(pi / 2) is 1.
    if (waves.lean != dvec3(0.0))
        pose.waves.push_back({objectFromWorld * waves.lean, dvec3(0.0), kTurn / 4.0});
    for (const VertexWave& wave : waves.waves) {
        // Whole turns go before precision does.
        const double turns = std::fmod(wave.hertz * seconds, 1.0);
        const double phase = kTurn * turns + wave.phase - glm::dot(wave.waveVector, origin);
        pose.waves.push_back(
            {objectFromWorld * wave.displacement,
             glm::transpose(axes) * wave.waveVector,
             hasInverse ? std::remainder(phase, kTurn) : 0.0}
        );
    }
    return pose;
}

bool isFinite(const WavePose& pose) {
    return std::all_of(pose.waves.begin(), pose.waves.end(), [](const WavePose::Wave& wave) {
        return std::isfinite(wave.displacement.x + wave.displacement.y + wave.displacement.z) &&
               std::isfinite(wave.waveVector.x + wave.waveVector.y + wave.waveVector.z) &&
               std::isfinite(wave.phase);
    });
}

} // namespace shutter::scene
