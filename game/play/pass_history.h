// SPDX-License-Identifier: MIT
#pragma once

#include "engine/render/renderer.h"

#include <cstddef>
#include <deque>
#include <span>
#include <string>
#include <vector>

namespace shutter::game {

/// Pass times of the last frames, for a stacked graph. Passes may come and go from frame to frame.
class PassHistory {
  public:
    static constexpr size_t kFrames = 240;

    /// The newest frame. Times of passes of one name are added up; a time that is no number or
    /// below 0 counts as 0.
    void add(const render::FrameStatistics& statistics);

    [[nodiscard]] size_t frameCount() const { return mFrames.size(); }

    /// Of the passes that at least one of the frames has, in the order of the frame.
    [[nodiscard]] std::span<const std::string> names() const { return mNames; }

    /// GPU milliseconds; 0 where the frame did not have the pass.
    /// \param frame 0 is the oldest \param pass index into names()
    [[nodiscard]] float milliseconds(size_t frame, size_t pass) const {
        return mFrames[frame][pass];
    }

    /// Over the frames, those without the pass included.
    [[nodiscard]] float findMedian(size_t pass) const;

  private:
    size_t findOrInsert(const std::string& name, size_t after);
    void forget(size_t pass);

    std::vector<std::string> mNames;
    std::deque<std::vector<float>> mFrames; ///< oldest first; milliseconds beside mNames
    std::deque<std::vector<bool>> mHas;     ///< likewise: the frame had the pass
};

} // namespace shutter::game
