// SPDX-License-Identifier: MIT
// Quality levels of a method, from the requested settings downwards.
#pragma once

#include "modules/motion_blur/budget.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::motion_blur {

/// Adds levels one by one, each cheaper than the last. Costs are shares of the first level's time.
class BudgetLadder {
  public:
    explicit BudgetLadder(const MotionBlurSettings& wanted);

    /// Half of the resolution where motion is long and uniform.
    void halveResolution(double cost);
    void shareRays(float share, double cost);
    void dropSecondRaster(double cost);
    void reduceSamples(uint32_t count, double cost);
    /// To 80, 60 and 40 % of `wanted`, then to the fewest that still blur; for a filter whose time
    /// is proportional to its samples. \param cost of the level before
    void reduceSamplesInSteps(uint32_t wanted, double cost);
    /// \param givenUp quality of the previous method that the new one lacks
    void changeMethod(std::string_view method, const char* givenUp, uint32_t samples, double cost);

    /// Settings of the level added last.
    [[nodiscard]] const MotionBlurSettings& next() const { return mNext; }

    /// The levels, and behind them the cheapest: `own_velocity` with the fewest samples.
    [[nodiscard]] std::vector<BudgetLevel> finish();

  private:
    void add(double cost);
    void addCheapest();

    MotionBlurSettings mWanted;
    MotionBlurSettings mNext = mWanted;
    uint32_t mMaxSamples = mWanted.sampleCount; ///< of the method that the levels have now
    std::string mResolution, mRaster, mRays, mSamples;
    std::vector<BudgetLevel> mLevels;
};

/// That share of the samples, but as many as it takes to blur at all.
[[nodiscard]] uint32_t shareOfSamples(uint32_t samples, double share);

/// Adds the levels of a method with lookups: no second raster, fewer instants, then each
/// pixel's own motion alone. \param cost of the level before
void addLookupLevels(BudgetLadder& ladder, const MotionBlurSettings& wanted, double cost);

/// Method::addBudgetLevels of a method that has nothing to give up but samples.
void addSampleLevels(BudgetLadder& ladder, const MotionBlurSettings& wanted);

} // namespace shutter::motion_blur
