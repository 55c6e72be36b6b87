// SPDX-License-Identifier: MIT
// A deformed mesh's way through the exposure, for rays that each have their own time: its place as
// motion_keys.h has it, and keys of its shape between which shaders interpolate each vertex
// linearly.
#pragma once

#include "engine/extract/motion_keys.h"
#include "engine/scene/deformation.h"
#include "engine/scene/deformed_bounds.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace shutter::extract {

/// Most intervals between keys of a shape: each has its own acceleration structure. What changes
/// faster than they can follow is drawn out over 1/256 of the exposure.
inline constexpr uint32_t kMaxDeformationIntervals = 256;

/// The shape at shutter time s in [0, 1].
using DeformationAt = std::function<scene::Deformation(double s)>;

struct DeformationKeys {
    /// One: it is static. Else 2^n + 1 at uniform shutter times, both ends included.
    std::vector<scene::Deformation> keys;
    math::Bounds swept;         ///< object space: holds every vertex at every shutter time
    bool followsExactly = true; ///< false: kMaxDeformationIntervals were not enough
};

struct DeformedMotion {
    MotionKeys object; ///< eyeFromObject; its swept box holds the deformed mesh
    DeformationKeys shape;
};

/// Most that any vertex of the pose half way (share t) between the keys a and b can be off `exact`
/// when it goes straight from one to the other, metres in object space. An upper bound, from the
/// joints' matrices, the weights and the waves alone: blending skins is linear in the matrices and,
/// at fixed matrices, in the weights; a wave is linear in sine and cosine of its phase.
[[nodiscard]] double measureDeformationDeviation(
    const scene::Deformation& exact,
    const scene::Deformation& a,
    const scene::Deformation& b,
    double t,
    const scene::PoseReach& reach
);

/// Place and shape each within the tolerance, looked at at 33 instants at least (see
/// computeMotionKeys).
/// \return nothing where place or shape is not finite at one of the instants
[[nodiscard]] std::optional<DeformedMotion> computeDeformedMotion(
    const MatrixAt& objectAt,
    const DeformationAt& deformAt,
    const scene::PoseReach& reach,
    const KeyTolerance& tolerance
);

} // namespace shutter::extract
