// SPDX-License-Identifier: MIT
// Which way is up for a path that looks at places, straight down and up included.
#pragma once

#include "engine/math/math.h"
#include "engine/scene/path.h"

namespace shutter::scene {

/// Rotation that looks with -Z along `direction`, with +Y towards the path's `up`.
///
/// Straight down and up (to 1e-6 of the angle) `up` says nothing: there the view is turned as the
/// path comes to it or, at the beginning of a shot, as it leaves. A path that leaves in another
/// direction than it came, as one that flies over its target does, therefore does not turn over: it
/// goes on as it came, and rolls until it is upright at the next key. Where it never is anything
/// else, +Y is the axis that `up` is farthest from. A place to look at that is the camera's own is
/// looked at along the way that it is come to, likewise.
/// \param place in the path
/// \param direction from the camera to what it looks at there, any length
[[nodiscard]] math::dquat
lookAlongPath(const PathMotion& path, const KeyPlace& place, const math::dvec3& direction);

} // namespace shutter::scene
