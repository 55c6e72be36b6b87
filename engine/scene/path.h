// SPDX-License-Identifier: MIT
// Paths through keys for cameras and other entities: one more source of motion.
#pragma once

#include "engine/core/result.h"
#include "engine/math/transform.h"
#include "engine/scene/key_interpolation.h"

#include <optional>
#include <vector>

namespace shutter::scene {

/// A place at a time, in the parent's space.
struct PathKey {
    double seconds = 0.0;
    math::dvec3 position{0.0};           ///< metres
    std::optional<math::dquat> rotation; ///< unit; all keys of a path have one or none has
    std::optional<math::dvec3> lookAt;   ///< target that -Z points at; likewise
    bool cut = false; ///< the path jumps to this key: until then it stays at the key before
};

/// Component: replaces LocalTransform's translation and, if the keys have rotations or targets, its
/// rotation, but not its scale. Overrides Animated; velocities are added; does not affect a
/// LocalMatrix. Before the first key and after the last the entity stays there. A cut on a camera's
/// path, or on its parents', is a camera cut, on any other entity it is a teleport (history.h). A
/// shot is the span between two cuts.
struct PathMotion {
    std::vector<PathKey> keys; ///< one or more, at rising times
    PathInterpolation interpolation = PathInterpolation::CatmullRom;
    PathEase ease = PathEase::None;
    math::dvec3 up{0.0, 1.0, 0.0}; ///< up direction for keys with lookAt
};

/// Error: one sentence that names the key and the fault.
[[nodiscard]] core::Status validatePath(const PathMotion& path);

/// Returns `rest` with the properties that the path drives replaced. The path must be valid.
/// \param seconds finite
[[nodiscard]] math::Transform
samplePath(const PathMotion& path, const math::Transform& rest, double seconds);

/// True when the path jumps after `from` and not after `to`.
[[nodiscard]] bool hasCutWithin(const PathMotion& path, double from, double to);

} // namespace shutter::scene
