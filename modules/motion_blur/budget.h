// SPDX-License-Identifier: MIT
// What the effect gives up to stay within a time: a ladder of rungs from what was asked for down to
// nothing, and who climbs it. Pure: times go in, settings come out.
#pragma once

#include "modules/motion_blur/settings.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace shutter::motion_blur {

/// GPU time that the effect may take of a frame.
struct BlurBudget {
    /// Above 0. Infinity: unlimited, nothing is measured and nothing given up.
    double milliseconds = std::numeric_limits<double>::infinity();

    [[nodiscard]] bool isUnlimited() const {
        return milliseconds == std::numeric_limits<double>::infinity();
    }
};

/// One sentence where the budget is no time above 0.
[[nodiscard]] core::Status validate(const BlurBudget& budget);

struct BudgetRung {
    MotionBlurSettings settings;
    bool runs = true;        ///< false on the last rung: no blur at all
    double cost = 1.0;       ///< guess: share of the first rung's time
    std::string gaveUp = ""; ///< against what was asked for; empty on the first rung
};

/// From the settings asked for to none at all; each rung costs less than the one before. Rungs give
/// up first what is seen least: half of the resolution along long uniform motion, then rays, then
/// samples, then the method.
[[nodiscard]] std::vector<BudgetRung> makeRungs(const MotionBlurSettings& wanted);

/// Chooses a rung from the times of the frames before. Goes down when two frames in a row took too
/// long, by one rung or, where half as much again was taken, to the one that is expected to fit.
/// Goes up by one when that is expected to leave a margin for a while; the wait doubles each time a
/// step up had to be taken back.
class BudgetController {
  public:
    /// Both must be valid.
    BudgetController(const BlurBudget& budget, const MotionBlurSettings& wanted);

    [[nodiscard]] const BlurBudget& budget() const { return mBudget; }

    /// Index of the rung to draw the next frame with.
    [[nodiscard]] size_t rung() const { return mRung; }

    [[nodiscard]] const BudgetRung& current() const { return mRungs[mRung]; }

    [[nodiscard]] size_t rungCount() const { return mRungs.size(); }

    /// A frame's time. \param rung it was drawn with; frames of other rungs than the current one
    /// came late and are passed over, as are times that are no number
    void observe(size_t rung, double milliseconds);

  private:
    [[nodiscard]] double predict(size_t rung) const;
    [[nodiscard]] size_t findFitting() const;
    void moveTo(size_t rung);
    void stepDown(double milliseconds);
    void considerStepUp();

    BlurBudget mBudget;
    std::vector<BudgetRung> mRungs;
    size_t mRung = 0;
    size_t mRungBefore = 0;
    double mSmoothed = 0.0;    ///< milliseconds on this rung
    double mOver = 0.0;        ///< least of the frames in a row that took too long
    uint32_t mFrames = 0;      ///< on this rung
    uint32_t mFramesOver = 0;  ///< in a row that took too long
    uint32_t mFramesUnder = 0; ///< in a row with room for the rung above
    uint32_t mWait;            ///< frames with room before a step up
};

} // namespace shutter::motion_blur
