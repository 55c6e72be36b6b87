// SPDX-License-Identifier: MIT
// A host's camera in the form that picture space is made of, and where it and movers are between
// their keys (HostMotion).
#pragma once

#include "engine/math/math.h"
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_motion.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace shutter::motion_blur {

/// Ahead is -Z, and the clip w is -z (perspective) or 1 (orthographic).
struct HostCamera {
    math::dmat4 viewFromWorld{1.0};
    math::dmat4 clipFromView{1.0};
    bool isPerspective = true;

    /// Picture space (layer_tables.h) from the world.
    [[nodiscard]] math::dmat4 pictureFromWorld(const math::uvec2& sizePx) const;
};

/// Nothing: the projection is neither of the two, or faces the other way. A key in that form
/// already is returned bit-identical.
[[nodiscard]] std::optional<HostCamera> normalize(const HostCameraKey& key, bool aheadIsPlusZ);

/// Whether the last row is (0, 0, 0, 1), to rounding.
[[nodiscard]] bool isAffine(const math::dmat4& matrix);

struct HostCameras;
struct HostConvention;

/// The cameras of a convention as they count: at a cut there is none before, and this frame's takes
/// its place.
[[nodiscard]] HostCameras countedCameras(const HostConvention& convention);

/// A time between two keys, or at one.
struct BetweenKeys {
    size_t from = 0;
    size_t to = 0;
    double share = 0.0;
};

/// Before the first key that one, after the last one that.
[[nodiscard]] BetweenKeys locate(std::span<const HostCameraKey> keys, double time);

class CameraWay {
  public:
    /// \param keys as checkMotion() accepts them
    CameraWay(std::span<const HostCameraKey> keys, bool aheadIsPlusZ);

    [[nodiscard]] HostCamera at(const BetweenKeys& place) const;

    [[nodiscard]] const HostCamera& atKey(size_t index) const { return mCameras[index]; }

  private:
    std::vector<HostCamera> mCameras; ///< one per key
    std::vector<math::Pose> mPoses;   ///< one per key: world from view
};

/// A mover's motion over the exposure.
class MoverWay {
  public:
    /// \param keys its matrices, at least one
    explicit MoverWay(std::span<const math::dmat4> keys);

    [[nodiscard]] math::dmat4 at(const BetweenKeys& place) const;

    /// Whether it is there, and nowhere else, all the time.
    [[nodiscard]] bool staysAt(const math::dmat4& worldFromObject) const {
        return mIsStill && mFirst == worldFromObject;
    }

  private:
    math::dmat4 mFirst;
    bool mIsStill = false;
    std::vector<math::Pose> mPoses; ///< one per key, unless it is still
};

} // namespace shutter::motion_blur
