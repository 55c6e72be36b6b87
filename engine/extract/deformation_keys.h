// SPDX-License-Identifier: MIT
// The motion of a deformed mesh over the exposure, for time-sampled rays: its place as in
// motion_keys.h, and keys of its shape between which shaders interpolate each vertex linearly.
#pragma once

#include "engine/extract/motion_keys.h"
#include "engine/scene/deformation.h"
#include "engine/scene/deformed_bounds.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace shutter::extract {

/// Maximum number of intervals between keys of a shape; each has its own acceleration structure.
/// Faster changes are spread over 1/256 of the exposure.
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
    MotionKeys object; ///< relWorldFromObject; its swept box holds the deformed mesh
    DeformationKeys shape;
};

/// Maximum distance, in metres in object space, of any vertex interpolated linearly between the
/// keys a and b (share t) from its place in `exact`. An upper bound, from the joints' matrices, the
/// weights and the waves alone: blending skins is linear in the matrices and, at fixed matrices, in
/// the weights; a wave is linear in sine and cosine of its phase.
[[nodiscard]] double measureDeformationDeviation(
    const scene::Deformation& exact,
    const scene::Deformation& a,
    const scene::Deformation& b,
    double t,
    const scene::PoseReach& reach
);

/// Computes keys of place and shape, each within the tolerance, probed at 33 instants or more (see
/// computeMotionKeys).
/// \return nothing where place or shape is not finite at one of the instants
[[nodiscard]] std::optional<DeformedMotion> computeDeformedMotion(
    const MatrixAt& objectAt,
    const DeformationAt& deformAt,
    const scene::PoseReach& reach,
    const KeyTolerance& tolerance
);

} // namespace shutter::extract
