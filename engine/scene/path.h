// SPDX-License-Identifier: MIT
// Paths through keys: the way of a camera or of anything else, one more source of motion.
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
    std::optional<math::dvec3> lookAt;   ///< place to look at with -Z; likewise
    bool cut = false; ///< the path jumps to this key: until then it stays at the key before
};

/// Component: replaces LocalTransform's translation and, where the keys tell one, its rotation;
/// scale stays. Wins over Animated; velocities are added; no say over a LocalMatrix. Before the
/// first key and after the last the entity stays there. A cut on a camera's path, or on its
/// parents', is a camera cut, on any other entity it is a teleport (history.h). A shot is what lies
/// between two cuts.
struct PathMotion {
    std::vector<PathKey> keys; ///< one or more, at rising times
    PathInterpolation interpolation = PathInterpolation::CatmullRom;
    PathEase ease = PathEase::None;
    math::dvec3 up{0.0, 1.0, 0.0}; ///< what is above where keys look at a place
};

/// One sentence that names the key and what is wrong with it.
[[nodiscard]] core::Status validatePath(const PathMotion& path);

/// `rest` with what the path tells replaced. The path must be valid.
/// \param seconds finite
[[nodiscard]] math::Transform
samplePath(const PathMotion& path, const math::Transform& rest, double seconds);

/// True when the path jumps after `from` and not after `to`.
[[nodiscard]] bool hasCutWithin(const PathMotion& path, double from, double to);

} // namespace shutter::scene
