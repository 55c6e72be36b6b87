// SPDX-License-Identifier: MIT
// Slow and fast motion: how fast a flythrough's film goes through the scene's time.
#pragma once

#include "engine/flythrough/flythrough.h"
#include "engine/scene/shutter.h"

#include <vector>

namespace shutter::flythrough {

/// Film time and scene time, each in seconds, both 0 together. Between two keys that tell a time
/// scale, it changes evenly over the scene's time; before the first such key and after the last it
/// stays as there. A flythrough whose keys tell none has one of 1: both times are the same, to the
/// bit.
class TimeRamp {
  public:
    /// \param flythrough valid
    explicit TimeRamp(const Flythrough& flythrough);

    /// Seconds of the scene per second of the film.
    [[nodiscard]] double scaleAt(double sceneSeconds) const;
    [[nodiscard]] double filmFromScene(double sceneSeconds) const;
    [[nodiscard]] double sceneFromFilm(double filmSeconds) const;

    /// The exposure of the frame at a time of the scene. The shutter is that of the film's camera,
    /// which runs as fast as the film goes slow: what it leaves open for half of a frame lets in
    /// half of the scene's time between two frames, and of exposures that follow one another
    /// without a gap in the film none leaves one in the scene. \param filmFrameSeconds duration of
    /// a frame of the film
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
    [[nodiscard]] size_t findByScene(double seconds) const;
    [[nodiscard]] size_t findByFilm(double seconds) const;
    /// By how much the scale grows per second of the scene behind a key.
    [[nodiscard]] double slopeAfter(size_t key) const;

    std::vector<Key> mKeys; ///< empty: the scale is 1
};

} // namespace shutter::flythrough
