// SPDX-License-Identifier: MIT
// Slow and fast motion: the rate of scene time over film time in a flythrough.
#pragma once

#include "engine/flythrough/flythrough.h"
#include "engine/scene/shutter.h"

#include <vector>

namespace shutter::flythrough {

/// Film time and scene time, each in seconds; both start at 0. Between two keys that have a time
/// scale, the scale changes evenly over the scene's time; before the first such key and after the
/// last it stays the same. Without any such key it is 1, and both times are the same, to the bit.
class TimeRamp {
  public:
    /// \param flythrough valid
    explicit TimeRamp(const Flythrough& flythrough);

    /// Seconds of the scene per second of the film.
    [[nodiscard]] double scaleAt(double sceneSeconds) const;
    [[nodiscard]] double filmFromScene(double sceneSeconds) const;
    [[nodiscard]] double sceneFromFilm(double filmSeconds) const;

    /// The exposure of the frame at a time of the scene. Opening and closing times of the film are
    /// brought to the scene, so that a shutter angle is a share of the scene's time between two
    /// frames, and exposures without a gap in the film have none in the scene.
    ///
    /// \param filmFrameSeconds duration of a frame of the film
    [[nodiscard]] scene::ExposureInterval computeExposure(
        const scene::CameraShutter& shutter, double sceneSeconds, double filmFrameSeconds
    ) const;

  private:
    struct Key {
        double scene = 0.0;
        double scale = 1.0;
        double film = 0.0; ///< at `scene`
    };

    /// The key whose span a time lies in: the last one before it, or the first.
    /// \param time Key::scene or Key::film, whichever `seconds` counts
    [[nodiscard]] size_t findKey(double Key::*time, double seconds) const;
    /// By how much the scale grows per second of the scene behind a key.
    [[nodiscard]] double slopeAfter(size_t key) const;

    std::vector<Key> mKeys; ///< empty: the scale is 1
};

} // namespace shutter::flythrough
