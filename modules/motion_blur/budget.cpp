// SPDX-License-Identifier: MIT
#include "modules/motion_blur/budget.h"

#include "engine/core/check.h"
#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/methods.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::motion_blur {

namespace {

constexpr double kSmoothing = 0.25;   ///< weight of a new frame's time
constexpr double kRoom = 0.85;        ///< of the budget, for the level above
constexpr double kFarOver = 1.5;      ///< of the budget: not one level but to where it fits
constexpr uint32_t kFramesOver = 2;   ///< one slow frame is a hiccup
constexpr uint32_t kMinWait = 15;     ///< frames
constexpr uint32_t kMaxWait = 960;    ///< frames
constexpr uint32_t kTrialFrames = 30; ///< a step up that ends within them has failed
constexpr uint32_t kCalmFrames = 4 * kTrialFrames; ///< after a step up: it has not failed

} // namespace

core::SettingRows<BlurBudget> listBudgetRows() {
    static const std::array<core::SettingRow<BlurBudget>, 1> kRows = {{
        {"milliseconds",
         &BlurBudget::milliseconds,
         "ms",
         {.lowest = 0,
          .highest = 1e9,
          .isLowestValid = false,
          .isUnlimited = true,
          .isLogarithmic = true,
          .sliderLowest = 0.1,
          .sliderHighest = 100},
         "GPU time per frame that the blur may take. To keep to it, the blur gives up resolution, "
         "rays and samples, but never itself: at worst four samples along each pixel's own motion "
         "remain.",
         "Budget",
         "--budget"},
    }};
    return kRows;
}

core::Status validate(const BlurBudget& budget) {
    return core::validateRows(listBudgetRows(), budget, "motion blur: budget.");
}

std::vector<BudgetLevel> makeLevels(const MotionBlurSettings& wanted) {
    const MotionBlurSettings whole = complete(wanted);
    BudgetLadder ladder(whole);
    whole.method->addBudgetLevels(ladder, whole);
    return ladder.finish();
}

BudgetController::BudgetController(const BlurBudget& budget, const MotionBlurSettings& wanted)
    : mBudget(budget), mLevels(makeLevels(wanted)), mWait(kMinWait) {
    const core::Status valid = validate(budget);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
}

void BudgetController::setBudget(const BlurBudget& budget) {
    const core::Status valid = validate(budget);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
    mBudget = budget;
    if (budget.isUnlimited() && mLevel > 0)
        moveTo(0);
}

double BudgetController::predict(size_t level) const {
    return mSmoothed * mLevels[level].cost / current().cost;
}

size_t BudgetController::findFitting() const {
    size_t level = mLevel + 1;
    while (level + 1 < mLevels.size() && predict(level) > mBudget.milliseconds)
        ++level;
    return level;
}

void BudgetController::moveTo(size_t level) {
    mLevelBefore = mLevel;
    mLevel = level;
    mFrames = mFramesOver = mFramesUnder = 0;
    mSmoothed = 0.0;
}

void BudgetController::stepDown(double milliseconds) {
    // Only the frames that took too long determine the new estimate.
    mSmoothed = milliseconds;
    const bool trialFailed = mLevelBefore > mLevel && mFrames <= kTrialFrames;
    if (trialFailed)
        mWait = std::min(2 * mWait, kMaxWait);
    moveTo(milliseconds > kFarOver * mBudget.milliseconds ? findFitting() : mLevel + 1);
}

void BudgetController::considerStepUp() {
    const bool room = predict(mLevel - 1) <= kRoom * mBudget.milliseconds;
    mFramesUnder = room ? mFramesUnder + 1 : 0;
    if (mFramesUnder >= mWait)
        moveTo(mLevel - 1);
}

void BudgetController::observe(size_t level, double milliseconds) {
    if (mBudget.isUnlimited() || level != mLevel || !std::isfinite(milliseconds) ||
        milliseconds < 0.0)
        return;
    mSmoothed = mFrames == 0 ? milliseconds : mSmoothed + kSmoothing * (milliseconds - mSmoothed);
    ++mFrames;
    mFramesOver = milliseconds > mBudget.milliseconds ? mFramesOver + 1 : 0;
    if (mFrames == kCalmFrames && mLevelBefore > mLevel)
        mWait = kMinWait;
    mOver = mFramesOver <= 1 ? milliseconds : std::min(mOver, milliseconds);
    if (mFramesOver >= kFramesOver && mLevel + 1 < mLevels.size())
        stepDown(mOver);
    else if (mLevel > 0)
        considerStepUp();
}

} // namespace shutter::motion_blur
