// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace shutter::core {

/// A bar with the time left on stderr, for work that takes over a second. Silent when stderr is no
/// terminal, and silent for the first second.
class Progress {
  public:
    /// \param label what is being done, e.g. "rendering"
    /// \param total number of steps, at least 1
    Progress(std::string label, uint64_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more step is done.
    void advance();

  private:
    void draw(double elapsedSeconds) const;

    std::string mLabel;
    uint64_t mTotal;
    uint64_t mDone = 0;
    bool mEnabled;
    bool mDrawn = false;
    std::chrono::steady_clock::time_point mStart;
    std::chrono::steady_clock::time_point mLastDraw;
};

} // namespace shutter::core
