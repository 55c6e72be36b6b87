// SPDX-License-Identifier: MIT
// What a session's frames took: the mean that the head-up display shows, and --stats.
#pragma once

#include "engine/core/result.h"
#include "engine/render/renderer.h"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shutter::game {

/// Facts that are constant during a session.
struct SessionFacts {
    std::string title;
    std::string device;
    std::string method; ///< at the end
    math::uvec2 size{1u};
    std::optional<int> score;
    bool isOver = false; ///< the game came to its end
    uint32_t validationMessages = 0;
};

class PlayRecord {
  public:
    /// \param wallSeconds from one picture to the next
    void addFrame(double wallSeconds);
    /// Statistics of a frame that was finished.
    void addStatistics(const render::FrameStatistics& statistics);

    /// A picture was drawn. \param seconds after the program's start; the first one's counts
    void addPicture(double seconds) {
        if (mPictureCount++ == 0)
            mStartSeconds = seconds;
    }

    /// What a device has allocated until a time of the game, seconds: later calls count from the
    /// first one after its first second.
    void addAllocations(double gameSeconds, uint64_t allocationCount) {
        if (gameSeconds >= 1.0 && !mFirstAllocations)
            mFirstAllocations = allocationCount;
        mLastAllocations = allocationCount;
    }

    [[nodiscard]] uint32_t pictureCount() const { return mPictureCount; }

    /// Mean of the last second's frames; 0 before the first.
    [[nodiscard]] double meanMilliseconds() const;

    /// As JSON, renamed into place: what follows, by the names of the members.
    [[nodiscard]] core::Status
    write(const std::filesystem::path& path, const SessionFacts& facts) const;

  private:
    std::vector<double> mMilliseconds;       ///< of all frames, wall
    std::vector<double> mBlurMilliseconds;   ///< of finished frames, GPU
    std::map<std::string, uint32_t> mPasses; ///< of the last finished frame: how often each ran
    /// GPU, by pass, of those frames that had it.
    std::map<std::string, std::vector<double>> mPassMilliseconds;
    std::deque<double> mRecent; ///< milliseconds of the last second
    double mRecentSum = 0.0;
    double mStartSeconds = 0.0;
    std::optional<uint64_t> mFirstAllocations; ///< once the first second is over
    uint64_t mLastAllocations = 0;
    uint32_t mReducedFrames = 0; ///< in which a budget made the blur give something up
    uint32_t mStandInFrames = 0; ///< that another method drew until pipelines were made
    uint32_t mPictureCount = 0;
};

} // namespace shutter::game
