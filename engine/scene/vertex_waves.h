// SPDX-License-Identifier: MIT
// Waves that displace the vertices of a mesh (VertexWaves), at one instant.
#pragma once

#include "engine/core/result.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"

#include <cstdint>
#include <vector>

namespace shutter::scene {

/// Which share of its waves a vertex follows: the same at all times.
struct WaveShares {
    WaveShare share = WaveShare::All;
    math::dvec4 height{0.0}; ///< Height: dot(xyz, p) + w, clamped to [0, 1]
    uint32_t channel = 3;    ///< Color
    double exponent = 1.0;
};

/// The waves of a mesh at one instant, in the space of its vertices; a lean is one more wave. As
/// many at every instant.
struct WavePose {
    struct Wave {
        math::dvec3 displacement{0.0}; ///< of a crest, metres
        math::dvec3 waveVector{0.0};   ///< radians per metre
        double phase = 0.0;            ///< radians, at the origin of the space

        [[nodiscard]] bool operator==(const Wave&) const = default;
    };

    std::vector<Wave> waves; ///< displacement * sin(phase - waveVector . p)
    WaveShares shares;
};

/// Error: one sentence that names the field and the fault.
[[nodiscard]] core::Status validateWaves(const VertexWaves& waves);

/// False when the waves are the same at every time.
[[nodiscard]] bool isRunning(const VertexWaves& waves);

/// \param seconds finite
/// \param worldFromObject of the entity then, for VertexWaves::inWorld. Where it flattens space,
///        no wave moves anything.
[[nodiscard]] WavePose poseWaves(
    const VertexWaves& waves, double seconds, const math::dmat4& worldFromObject = math::dmat4(1.0)
);

[[nodiscard]] bool isFinite(const WavePose& pose);

} // namespace shutter::scene
