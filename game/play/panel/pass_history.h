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

    /// Adds the newest frame. Times of passes with the same name and owner are added up; a time
    /// that is NaN, infinite or below 0 counts as 0.
    void add(const render::FrameStatistics& statistics);

    [[nodiscard]] size_t frameCount() const { return mFrames.size(); }

    struct Pass {
        std::string name;
        render::PassOwner owner = render::PassOwner::Scene;

        bool operator==(const Pass&) const = default;
    };

    /// The passes that at least one of the frames has, in the order of the frame.
    [[nodiscard]] std::span<const Pass> passes() const { return mPasses; }

    /// GPU milliseconds; 0 where the frame did not have the pass.
    /// \param frame 0 is the oldest \param pass index into passes()
    [[nodiscard]] float milliseconds(size_t frame, size_t pass) const {
        return mFrames[frame][pass];
    }

    /// Over the frames, those without the pass included.
    [[nodiscard]] float findMedian(size_t pass) const;

  private:
    size_t findOrInsert(const Pass& pass, size_t after);
    void forget(size_t pass);

    std::vector<Pass> mPasses;
    std::deque<std::vector<float>> mFrames; ///< oldest first; milliseconds parallel to mPasses
    std::deque<std::vector<bool>> mHas;     ///< likewise: the frame had the pass
};

} // namespace shutter::game
