// SPDX-License-Identifier: MIT
// Reduces quality to stay within a time budget: a ladder of levels from the requested settings down
// to the cheapest blur, and a controller that moves on it. Pure functions of measured times.
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
    /// Infinity: unlimited; nothing is measured and quality is never reduced.
    double milliseconds = std::numeric_limits<double>::infinity();

    [[nodiscard]] bool isUnlimited() const {
        return milliseconds == std::numeric_limits<double>::infinity();
    }
};

/// One row per field of BlurBudget.
[[nodiscard]] core::SettingRows<BlurBudget> listBudgetRows();

/// One sentence if the budget is out of its range.
[[nodiscard]] core::Status validate(const BlurBudget& budget);

struct BudgetLevel {
    MotionBlurSettings settings;
    double cost = 1.0;               ///< guess: share of the first level's time
    std::string droppedQuality = ""; ///< quality dropped against the requested settings; empty on
                                     ///< the first level
};

/// Makes levels from the requested settings down to four samples along each pixel's motion; each
/// level costs less than the one before, and each blurs. The least visible quality is dropped
/// first: half of the resolution along long uniform motion, then rays, then samples, then the
/// method.
[[nodiscard]] std::vector<BudgetLevel> makeLevels(const MotionBlurSettings& wanted);

/// Chooses a level from the times of earlier frames. Steps down when two consecutive frames took
/// too long, by one level or, if they took half as much again, to the one that is expected to fit.
/// Steps up by one when that is expected to leave a margin for a while; the wait doubles each time
/// a step up had to be reverted.
class BudgetController {
  public:
    /// Both must be valid.
    BudgetController(const BlurBudget& budget, const MotionBlurSettings& wanted);

    [[nodiscard]] const BlurBudget& budget() const { return mBudget; }

    /// Another limit for the frames to come, which must be valid. The level stays, and follows the
    /// new limit frame by frame; without a limit it is the first at once.
    void setBudget(const BlurBudget& budget);

    /// Index of the level to draw the next frame with.
    [[nodiscard]] size_t level() const { return mLevel; }

    [[nodiscard]] const BudgetLevel& current() const { return mLevels[mLevel]; }

    [[nodiscard]] size_t levelCount() const { return mLevels.size(); }

    /// Takes a frame's time. NaN is ignored.
    /// \param level with which it was drawn; a frame of another level than the current one is late
    /// and ignored
    void observe(size_t level, double milliseconds);

  private:
    [[nodiscard]] double predict(size_t level) const;
    [[nodiscard]] size_t findFitting() const;
    void moveTo(size_t level);
    void stepDown(double milliseconds);
    void considerStepUp();

    BlurBudget mBudget;
    std::vector<BudgetLevel> mLevels;
    size_t mLevel = 0;
    size_t mLevelBefore = 0;
    double mSmoothed = 0.0;    ///< milliseconds on this level
    double mOver = 0.0;        ///< least of the frames in a row that took too long
    uint32_t mFrames = 0;      ///< on this level
    uint32_t mFramesOver = 0;  ///< in a row that took too long
    uint32_t mFramesUnder = 0; ///< in a row with room for the level above
    uint32_t mWait;            ///< frames with room before a step up
};

} // namespace shutter::motion_blur
