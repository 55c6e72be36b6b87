// SPDX-License-Identifier: MIT
// What a session's frames took: the mean that the head-up display shows, and --stats.
#pragma once

#include "engine/core/result.h"
#include "engine/render/renderer.h"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shutter::game {

/// What does not change from frame to frame.
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
    /// A frame was shown. \param wallSeconds since the one before
    void addFrame(double wallSeconds);
    /// Statistics of a frame that was finished.
    void addStatistics(const render::FrameStatistics& statistics);

    /// The first picture was shown. \param seconds after the program's start
    void setStart(double seconds) { mStartSeconds = seconds; }

    [[nodiscard]] bool hasStarted() const { return mStartSeconds > 0.0; }

    /// Mean of the last second's frames; 0 before the first.
    [[nodiscard]] double meanMilliseconds() const;

    [[nodiscard]] uint32_t frameCount() const {
        return static_cast<uint32_t>(mMilliseconds.size());
    }

    /// Renamed into place; schema in game/play/README.md, "Statistics".
    [[nodiscard]] core::Status
    write(const std::filesystem::path& path, const SessionFacts& facts) const;

  private:
    std::vector<double> mMilliseconds;     ///< of all frames, wall
    std::vector<double> mBlurMilliseconds; ///< of finished frames, GPU
    std::deque<double> mRecent;            ///< milliseconds of the last second
    double mRecentSum = 0.0;
    double mStartSeconds = 0.0;
};

} // namespace shutter::game
