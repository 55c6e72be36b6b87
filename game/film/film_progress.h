// SPDX-License-Identifier: MIT
// What can be told of parts that other processes draw: how far they are, and what they said last.
#pragma once

#include "engine/core/progress.h"
#include "game/film/film.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace shutter::film {

/// The last line of an output that holds anything, without "shutter: " in front. Empty: none does.
[[nodiscard]] std::string findLastSentence(std::string_view output);

/// A bar over the frames of all parts that were missing when it was made.
class FrameProgress {
  public:
    /// \param film outlives this
    explicit FrameProgress(const Film& film);

    /// Looks at the journals and advances the bar.
    void look();

  private:
    const Film& mFilm;
    uint32_t mDrawn;
    core::Progress mBar;
};

} // namespace shutter::film
