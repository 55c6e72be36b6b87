// SPDX-License-Identifier: MIT
#include "modules/motion_blur/budget.h"

#include "engine/core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::motion_blur {

namespace {

constexpr double kSmoothing = 0.25;   ///< weight of a new frame's time
constexpr double kRoom = 0.85;        ///< of the budget, for the level above
constexpr double kFarOver = 1.5;      ///< of the budget: not one level but to where it fits
constexpr uint32_t kFramesOver = 2;   ///< one slow frame is a hiccup
constexpr uint32_t kLeastWait = 15;   ///< frames
constexpr uint32_t kMostWait = 960;   ///< frames
constexpr uint32_t kTrialFrames = 30; ///< a step up that ends within them has failed
constexpr uint32_t kCalmFrames = 4 * kTrialFrames; ///< after a step up: it has not failed
constexpr float kHalfResolutionPx = 8.0f; ///< motion long enough for half of the resolution
constexpr uint32_t kLeastSamples = 4;     ///< fewer are no blur but ghosts

/// Adds levels one by one, each below the last.
class Ladder {
  public:
    explicit Ladder(const MotionBlurSettings& wanted) : mWanted(wanted) {
        mLevels.push_back({wanted, true, 1.0, ""});
    }

    /// Half of the resolution where motion is long and uniform.
    void halveResolution(double cost) {
        // It is a matter of the uniform path, which may be off.
        if (!(mNext.halfResolutionPx > kHalfResolutionPx) || !(mNext.uniformMotionPx > 0.0f))
            return;
        mNext.halfResolutionPx = kHalfResolutionPx;
        mResolution = "half of the resolution along long uniform motion";
        add(cost);
    }

    void shareRays(float share, double cost) {
        if (!(share < mNext.rayShare))
            return;
        mNext.rayShare = share;
        mRays = fmt::format("{:.0f} % of the rays", 100.0 * (1.0 - share / mWanted.rayShare));
        add(cost);
    }

    void reduceSamples(uint32_t count, double cost) {
        if (count >= mNext.sampleCount)
            return;
        mNext.sampleCount = count;
        mSamples = fmt::format("{} of {} samples", mMostSamples - count, mMostSamples);
        add(cost);
    }

    void changeMethod(Method method, const char* givenUp, uint32_t samples, double cost) {
        mNext.method = method;
        mNext.sampleCount = samples;
        mRays = givenUp;
        if (mWanted.method == Method::Denoised) { // whose samples were the rays
            mSamples.clear();
            mMostSamples = samples;
        }
        add(cost);
    }

    std::vector<BudgetLevel> finish() {
        mLevels.push_back({mNext, false, 0.0, "motion blur altogether"});
        return std::move(mLevels);
    }

    [[nodiscard]] const MotionBlurSettings& next() const { return mNext; }

  private:
    void add(double cost) {
        std::string gaveUp;
        for (const std::string& part : {mResolution, mRays, mSamples})
            if (!part.empty())
                gaveUp += (gaveUp.empty() ? "" : ", ") + part;
        mLevels.push_back({mNext, true, cost, gaveUp});
    }

    MotionBlurSettings mWanted;
    MotionBlurSettings mNext = mWanted;
    uint32_t mMostSamples = mWanted.sampleCount; ///< of the method that levels have now
    std::string mResolution, mRays, mSamples;
    std::vector<BudgetLevel> mLevels;
};

uint32_t shareOf(uint32_t samples, double share) {
    return std::max(kLeastSamples, static_cast<uint32_t>(std::lround(samples * share)));
}

/// The levels of a filter whose time goes with its samples. \param cost of the level before
void addSampleLevels(Ladder& ladder, uint32_t wanted, double cost) {
    const uint32_t first = ladder.next().sampleCount;
    for (const double share : {0.8, 0.6, 0.4, 0.0}) {
        const uint32_t count = shareOf(wanted, share);
        ladder.reduceSamples(count, cost * (0.15 + 0.85 * count / first));
    }
}

} // namespace

core::Status validate(const BlurBudget& budget) {
    // Written so that NaN fails.
    if (budget.milliseconds > 0.0)
        return {};
    return core::makeError(
        "motion blur: a budget of {} ms is no time above 0", budget.milliseconds
    );
}

std::vector<BudgetLevel> makeLevels(const MotionBlurSettings& wanted) {
    Ladder ladder(wanted);
    const uint32_t samples = wanted.sampleCount;
    switch (wanted.method) {
    case Method::Hybrid:
        ladder.halveResolution(0.95);
        for (const float share : {0.75f, 0.5f, 0.25f})
            ladder.shareRays(share * wanted.rayShare, 0.5 + 0.42 * share);
        ladder.reduceSamples(shareOf(samples, 0.8), 0.56);
        ladder.reduceSamples(shareOf(samples, 0.6), 0.5);
        ladder.changeMethod(Method::Gather, "all rays", ladder.next().sampleCount, 0.35);
        addSampleLevels(ladder, samples, 0.35);
        break;
    case Method::Gather:
        ladder.halveResolution(0.9);
        addSampleLevels(ladder, samples, 0.9);
        break;
    case Method::Denoised:
        for (uint32_t rays = samples / 2; rays >= 1; rays /= 2)
            ladder.reduceSamples(rays, double(rays) / samples);
        ladder.changeMethod(
            Method::Gather, "all rays", MotionBlurSettings{}.sampleCount, 0.1 / samples
        );
        addSampleLevels(ladder, ladder.next().sampleCount, 0.1 / samples);
        break;
    case Method::OwnVelocity:
    case Method::McGuire2012:
    case Method::Guertin2014:
    case Method::Jimenez2014:
        addSampleLevels(ladder, samples, 1.0);
        break;
    }
    return ladder.finish();
}

BudgetController::BudgetController(const BlurBudget& budget, const MotionBlurSettings& wanted)
    : mBudget(budget), mLevels(makeLevels(wanted)), mWait(kLeastWait) {
    const core::Status valid = validate(budget);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
}

double BudgetController::predict(size_t level) const {
    return current().runs ? mSmoothed * mLevels[level].cost / current().cost : 0.0;
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
    // The frames that took too long, not those before them, say how long.
    mSmoothed = milliseconds;
    const bool trialFailed = mLevelBefore > mLevel && mFrames <= kTrialFrames;
    if (trialFailed)
        mWait = std::min(2 * mWait, kMostWait);
    moveTo(milliseconds > kFarOver * mBudget.milliseconds ? findFitting() : mLevel + 1);
}

void BudgetController::considerStepUp() {
    // Without blur there is no time to judge by: it is tried again after the wait.
    const bool room = !current().runs || predict(mLevel - 1) <= kRoom * mBudget.milliseconds;
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
        mWait = kLeastWait;
    mOver = mFramesOver <= 1 ? milliseconds : std::min(mOver, milliseconds);
    if (mFramesOver >= kFramesOver && mLevel + 1 < mLevels.size())
        stepDown(mOver);
    else if (mLevel > 0)
        considerStepUp();
}

} // namespace shutter::motion_blur
