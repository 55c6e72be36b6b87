// SPDX-License-Identifier: MIT
// A host's camera in the form that picture space is made of.
#pragma once

#include "engine/math/math.h"
#include "modules/motion_blur/embedding/host_motion.h"

#include <optional>

namespace shutter::motion_blur {

/// Ahead is -Z, and the clip w is -z (perspective) or 1 (orthographic).
struct HostCamera {
    math::dmat4 viewFromWorld{1.0};
    math::dmat4 clipFromView{1.0};
    bool isPerspective = true;

    /// Picture space (layer_tables.h) from the world.
    [[nodiscard]] math::dmat4 pictureFromWorld(const math::uvec2& sizePx) const;
};

/// Nothing: the projection is neither of the two, or looks the other way. A key that has the form
/// already keeps its bits.
[[nodiscard]] std::optional<HostCamera> normalize(const HostCameraKey& key, bool aheadIsPlusZ);

/// Whether the last row is (0, 0, 0, 1), to rounding.
[[nodiscard]] bool isAffine(const math::dmat4& matrix);

struct HostCameras;
struct HostConvention;

/// The cameras of a convention as they count: at a cut there is none before, and this frame's takes
/// its place.
[[nodiscard]] HostCameras countedCameras(const HostConvention& convention);

} // namespace shutter::motion_blur
