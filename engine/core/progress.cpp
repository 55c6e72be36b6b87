// SPDX-License-Identifier: MIT
#include "engine/core/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace shutter::core {

namespace {

using Seconds = std::chrono::duration<double>;
constexpr double kSilentSeconds = 1.0;
constexpr double kRedrawSeconds = 0.1;
constexpr int kBarCells = 30;

} // namespace

Progress::Progress(std::string label, uint64_t total)
    : mLabel(std::move(label)), mTotal(std::max<uint64_t>(total, 1)),
      mEnabled(isatty(fileno(stderr)) != 0), mStart(std::chrono::steady_clock::now()),
      mLastDraw(mStart) {}

Progress::~Progress() {
    if (mDrawn)
        fmt::print(stderr, "\r\x1b[K");
}

void Progress::advance() {
    mDone = std::min(mDone + 1, mTotal);
    if (!mEnabled)
        return;
    const auto now = std::chrono::steady_clock::now();
    const double elapsed = Seconds(now - mStart).count();
    if (elapsed < kSilentSeconds || Seconds(now - mLastDraw).count() < kRedrawSeconds)
        return;
    mLastDraw = now;
    mDrawn = true;
    draw(elapsed);
}

void Progress::draw(double elapsedSeconds) const {
    const double share = static_cast<double>(mDone) / static_cast<double>(mTotal);
    const int filled = static_cast<int>(share * kBarCells);
    const double left = mDone > 0 ? elapsedSeconds * (1.0 - share) / share : 0.0;
    fmt::print(
        stderr,
        "\r\x1b[K{} [{:=<{}}{: <{}}] {}/{}  {:.0f} s left",
        mLabel,
        "",
        filled,
        "",
        kBarCells - filled,
        mDone,
        mTotal,
        left
    );
    std::fflush(stderr);
}

} // namespace shutter::core
