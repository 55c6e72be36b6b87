// SPDX-License-Identifier: MIT
// Converts wall-clock time to fixed simulation steps: pause, single steps, slow motion.
#pragma once

#include <cstdint>

namespace shutter::app {

/// Maximum wall time that one frame simulates: after a hitch the game continues at normal speed.
inline constexpr double kMaxCatchUpSeconds = 0.25;

/// What one frame is to do.
struct FrameTime {
    uint32_t steps = 0;    ///< fixed steps to simulate before it is drawn
    double seconds = 0.0;  ///< game time to draw, not after the simulated
    double duration = 0.0; ///< game time since the previous frame; the last one's while it is
                           ///< paused
};

class StepClock {
  public:
    /// \param stepSeconds of a fixed step, above 0
    explicit StepClock(double stepSeconds) : mStepSeconds(stepSeconds) {}

    /// Game seconds a wall second, [0.01, 4]; clamped.
    void setSpeed(double speed);

    [[nodiscard]] double speed() const { return mSpeed; }

    void setPaused(bool paused) { mPaused = paused; }

    [[nodiscard]] bool isPaused() const { return mPaused; }

    /// The next frame advances by this although it is paused. \param seconds above 0
    void stepOnce(double seconds) { mPendingSeconds = seconds; }

    /// \param wallSeconds since the previous frame; negative values and NaN count as 0. Equal
    /// values give equal frames, which makes scripts reproducible
    [[nodiscard]] FrameTime advance(double wallSeconds);

  private:
    double mStepSeconds;
    double mSpeed = 1.0;
    bool mPaused = false;
    double mPendingSeconds = 0.0;
    double mSeconds = 0.0;  ///< of the last frame
    double mDuration = 0.0; ///< of the last frame that moved
    uint64_t mSteps = 0;    ///< simulated
};

} // namespace shutter::app
