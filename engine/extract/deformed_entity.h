// SPDX-License-Identifier: MIT
// The shape of a skinned or morphed mesh as one frame needs it, on the CPU.
#pragma once

#include "engine/math/bounds.h"
#include "engine/scene/deformed_bounds.h"
#include "engine/scene/exposure_motion.h"

#include <cstdint>
#include <optional>

namespace shutter::extract {

struct DeformedEntity {
    uint32_t row = 0;                        ///< of the entity table
    uint32_t mesh = 0;                       ///< index into Assets::meshes
    const scene::PoseReach* reach = nullptr; ///< of the mesh: SceneLayout's, which outlives this
    scene::Deformation open;
    scene::Deformation raster;
    scene::Deformation close;
    math::Bounds bounds;  ///< raster instant, object space: holds every vertex
    bool changes = false; ///< open, raster instant and close are not one shape
    /// The joint that moves the whole shape, if the shape changes like a rotating rigid body: at
    /// each of the three times the joint's matrix gives the shape. Nothing: it deforms, or does not
    /// change.
    std::optional<uint32_t> carrier;
    bool mirrored = false; ///< the joints reverse the winding
};

/// Shutter times of a frame's three shapes, [0, 1].
struct ShutterTimes {
    double open = 0.0;
    double raster = 1.0;
    double close = 1.0;
};

/// Without `row` and `mesh`; `reach` must outlive it. Nothing where the entity cannot be drawn: a
/// joint that deforms something, or a weight, is not finite at one of the times, or there are no
/// vertices.
[[nodiscard]] std::optional<DeformedEntity> poseEntity(
    const scene::ExposureMotion& motion,
    ecs::Entity entity,
    const scene::PoseReach& reach,
    const ShutterTimes& times
);

/// Every weight, and every joint that deforms something, is.
[[nodiscard]] bool isFinite(const scene::Deformation& pose, const scene::PoseReach& reach);

/// Most matrices of joints that deform something mirror; those without a volume do not count.
[[nodiscard]] bool isMirrored(const scene::Deformation& pose, const scene::PoseReach& reach);

[[nodiscard]] bool isSame(const scene::Deformation& a, const scene::Deformation& b);

/// Maximum difference of two poses of one shape due to rounding, metres: the resolution of single
/// precision, in which vertices are stored.
/// \param bounds of the shape, object space
[[nodiscard]] double measureRounding(const math::Bounds& bounds);

/// Whether no vertex moves by more than `tolerance`, metres.
[[nodiscard]] bool isNear(
    const scene::Deformation& a,
    const scene::Deformation& b,
    const scene::PoseReach& reach,
    double tolerance
);

/// A joint whose matrix takes the whole shape from the first pose to the second, each vertex to
/// within `tolerance`, metres; nothing: it deforms.
[[nodiscard]] std::optional<uint32_t> findCarrier(
    const scene::Deformation& from,
    const scene::Deformation& to,
    const scene::PoseReach& reach,
    double tolerance
);

} // namespace shutter::extract
