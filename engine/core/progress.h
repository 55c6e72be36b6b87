// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace shutter::core {

/// "label [=====     ] 5/10  3 s left"; the time left assumes that every step takes as long.
/// \param done steps done, at most `total`; at 0 the time is unknown and "? s left" is printed
[[nodiscard]] std::string
formatProgress(std::string_view label, uint64_t done, uint64_t total, double elapsedSeconds);

/// A bar with the time left on stderr, for work that takes over a second; silent for the first
/// second. Where the output is no terminal, there is no bar, but lines if the work has parts or
/// wants them.
class Progress {
  public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Clock = TimePoint (*)();

    /// \param label the activity, e.g. "rendering"
    /// \param total number of steps; 0 counts as 1
    Progress(std::string label, uint64_t total);
    /// \param output where the bar goes; must outlive the bar
    /// \param clock source of the time, for tests
    Progress(std::string label, uint64_t total, std::FILE* output, Clock clock);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Advances by completed steps.
    void advance(uint64_t steps = 1);

    /// From now on, where the output is no terminal, advance() prints a line at most every ten
    /// seconds, "shutter: rendering: 12 % done, 230 s left".
    void printLines() { mPrintsLines = true; }

    /// Names the part of the work that begins: where the output is no terminal, prints one line
    /// with it and the share that is done, "shutter: measuring vase: gather; 12 % done".
    void startPart(std::string_view part);

  private:
    std::string mLabel;
    uint64_t mTotal;
    uint64_t mDone = 0;
    std::FILE* mOutput;
    Clock mClock;
    bool mEnabled;
    bool mPrintsLines = false;
    bool mDrawn = false;
    TimePoint mStart;
    TimePoint mLastDraw;
};

} // namespace shutter::core
