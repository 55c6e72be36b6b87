// SPDX-License-Identifier: MIT
// Where a host's camera and movers are between their keys (HostMotion).
#pragma once

#include "engine/math/math.h"
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_camera.h"
#include "modules/motion_blur/embedding/host_motion.h"

#include <cstddef>
#include <span>
#include <vector>

namespace shutter::motion_blur {

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

/// A mover's way through the exposure.
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
