// SPDX-License-Identifier: MIT
#include "modules/motion_blur/budget_ladder.h"

#include "engine/core/words.h"
#include "modules/motion_blur/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::motion_blur {

namespace {

constexpr float kHalfResolutionPx = 8.0f; ///< motion long enough for half of the resolution
constexpr uint32_t kMinSamples = 4;       ///< fewer show ghosts, not blur

} // namespace

BudgetLadder::BudgetLadder(const MotionBlurSettings& wanted) : mWanted(wanted) {
    mLevels.push_back({wanted, 1.0, ""});
}

void BudgetLadder::halveResolution(double cost) {
    // Only the path for uniform motion has it, which may be off.
    if (!(mNext.halfResolutionPx > kHalfResolutionPx) || !(mNext.uniformMotionPx > 0.0f))
        return;
    mNext.halfResolutionPx = kHalfResolutionPx;
    mResolution = "half of the resolution along long uniform motion";
    add(cost);
}

void BudgetLadder::shareRays(float share, double cost) {
    if (!(share < mNext.rayShare))
        return;
    mNext.rayShare = share;
    mRays = fmt::format("{:.0f} % of the rays", 100.0 * (1.0 - share / mWanted.rayShare));
    add(cost);
}

void BudgetLadder::dropSecondRaster(double cost) {
    if (!mNext.secondRaster)
        return;
    mNext.secondRaster = false;
    mRaster = "the second raster";
    add(cost);
}

void BudgetLadder::reduceSamples(uint32_t count, double cost) {
    if (count >= mNext.sampleCount)
        return;
    mNext.sampleCount = count;
    mSamples = fmt::format("{} of {} samples", mMaxSamples - count, mMaxSamples);
    add(cost);
}

void BudgetLadder::reduceSamplesInSteps(uint32_t wanted, double cost) {
    const uint32_t first = mNext.sampleCount;
    for (const double share : {0.8, 0.6, 0.4, 0.0}) {
        const uint32_t count = shareOfSamples(wanted, share);
        reduceSamples(count, cost * (0.15 + 0.85 * count / first));
    }
}

void BudgetLadder::changeMethod(
    std::string_view method, const char* givenUp, uint32_t samples, double cost
) {
    if (mWanted.method->sampleUnit != getMethod(method).sampleUnit) {
        mSamples.clear(); // they counted something else
        mMaxSamples = samples;
    }
    mNext.method = &getMethod(method);
    mNext.sampleCount = samples;
    mRays = givenUp;
    add(cost);
}

std::vector<BudgetLevel> BudgetLadder::finish() {
    addCheapest();
    return std::move(mLevels);
}

void BudgetLadder::add(double cost) {
    std::string droppedQuality;
    for (const std::string& part : {mResolution, mRaster, mRays, mSamples})
        if (!part.empty())
            droppedQuality += (droppedQuality.empty() ? "" : ", ") + part;
    mLevels.push_back({mNext, cost, droppedQuality});
}

void BudgetLadder::addCheapest() {
    MotionBlurSettings cheapest = mNext;
    cheapest.method = &getMethod("own_velocity");
    cheapest.occluderTest = OccluderTest::None;
    if (mWanted.method->sampleUnit == SampleUnit::Taps)
        cheapest.sampleCount = std::min(mWanted.sampleCount, kMinSamples);
    else
        cheapest.sampleCount = kMinSamples;
    if (mLevels.back().settings.method == cheapest.method &&
        mLevels.back().settings.sampleCount <= cheapest.sampleCount &&
        mLevels.back().settings.occluderTest == OccluderTest::None)
        return;
    mLevels.push_back(
        {cheapest,
         0.5 * mLevels.back().cost,
         fmt::format(
             "all but {} along each pixel's own motion",
             core::countOf(cheapest.sampleCount, "sample")
         )}
    );
}

uint32_t shareOfSamples(uint32_t samples, double share) {
    return std::max(kMinSamples, static_cast<uint32_t>(std::lround(samples * share)));
}

void addLookupLevels(BudgetLadder& ladder, const MotionBlurSettings& wanted, double cost) {
    if (wanted.secondRaster) {
        cost *= 0.6; // drawing it takes as long as a sharp picture
        ladder.dropSecondRaster(cost);
    }
    ladder.reduceSamples(shareOfSamples(wanted.sampleCount, 0.8), 0.85 * cost);
    ladder.reduceSamples(shareOfSamples(wanted.sampleCount, 0.6), 0.7 * cost);
    ladder.reduceSamples(shareOfSamples(wanted.sampleCount, 0.4), 0.6 * cost);
    // Not `gather`, which takes twice as long and, under a moving camera, is farther from the
    // truth.
    constexpr uint32_t kTaps = 8;
    ladder.changeMethod(
        "own_velocity", "the blur beyond the outlines of movers", kTaps, 0.12 * cost
    );
}

void addSampleLevels(BudgetLadder& ladder, const MotionBlurSettings& wanted) {
    ladder.reduceSamplesInSteps(wanted.sampleCount, 1.0);
}

} // namespace shutter::motion_blur
