// SPDX-License-Identifier: MIT
#include "engine/core/progress.h"

#include "engine/core/platform.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace shutter::core {

namespace {

using Seconds = std::chrono::duration<double>;
constexpr double kSilentSeconds = 1.0;
constexpr double kRedrawSeconds = 0.1;
constexpr double kLineSeconds = 10.0;
constexpr int kBarCells = 30;

Progress::TimePoint readClock() {
    return std::chrono::steady_clock::now();
}

std::string formatSecondsLeft(double share, double elapsedSeconds) {
    return share > 0.0 ? fmt::format("{:.0f}", elapsedSeconds * (1.0 - share) / share) : "?";
}

} // namespace

std::string
formatProgress(std::string_view label, uint64_t done, uint64_t total, double elapsedSeconds) {
    const double share = static_cast<double>(done) / static_cast<double>(total);
    const int filled = static_cast<int>(share * kBarCells);
    const std::string left = formatSecondsLeft(share, elapsedSeconds);
    return fmt::format(
        "{} [{:=<{}}{: <{}}] {}/{}  {} s left",
        label,
        "",
        filled,
        "",
        kBarCells - filled,
        done,
        total,
        left
    );
}

Progress::Progress(std::string label, uint64_t total)
    : Progress(std::move(label), total, stderr, readClock) {}

Progress::Progress(std::string label, uint64_t total, std::FILE* output, Clock clock)
    : mLabel(std::move(label)), mTotal(std::max<uint64_t>(total, 1)), mOutput(output),
      mClock(clock), mEnabled(isTerminal(output)), mStart(clock()), mLastDraw(mStart) {}

Progress::~Progress() {
    if (!mDrawn)
        return;
    fmt::print(mOutput, "\r\x1b[K");
    std::fflush(mOutput);
}

void Progress::startPart(std::string_view part) {
    if (mEnabled)
        return;
    fmt::print(mOutput, "shutter: {} {}; {} % done\n", mLabel, part, 100 * mDone / mTotal);
    std::fflush(mOutput);
}

void Progress::advance(uint64_t steps) {
    mDone = std::min(mDone + steps, mTotal);
    if (!mEnabled && !mPrintsLines)
        return;
    const TimePoint now = mClock();
    const double elapsed = Seconds(now - mStart).count();
    const double pause = Seconds(now - mLastDraw).count();
    if (elapsed < kSilentSeconds || pause < (mEnabled ? kRedrawSeconds : kLineSeconds))
        return;
    mLastDraw = now;
    if (!mEnabled) {
        fmt::print(
            mOutput,
            "shutter: {}: {} % done, {} s left\n",
            mLabel,
            100 * mDone / mTotal,
            formatSecondsLeft(double(mDone) / double(mTotal), elapsed)
        );
        std::fflush(mOutput);
        return;
    }
    mDrawn = true;
    fmt::print(mOutput, "\r\x1b[K{}", formatProgress(mLabel, mDone, mTotal, elapsed));
    std::fflush(mOutput);
}

} // namespace shutter::core
