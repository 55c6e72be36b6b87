// SPDX-License-Identifier: MIT
#include "game/film/film_progress.h"

namespace shutter::film {

std::string findLastSentence(std::string_view output) {
    const size_t end = output.find_last_not_of(" \r\n");
    if (end == std::string_view::npos)
        return {};
    output = output.substr(0, end + 1);
    const size_t start = output.rfind('\n');
    std::string_view line = start == std::string_view::npos ? output : output.substr(start + 1);
    constexpr std::string_view kName = "shutter: ";
    if (line.starts_with(kName))
        line.remove_prefix(kName.size());
    return std::string(line);
}

FrameProgress::FrameProgress(const Film& film)
    : mFilm(film), mDrawn(countDrawnFrames(film)),
      mBar("rendering", film.plan.frameCount() - mDrawn) {}

void FrameProgress::look() {
    const uint32_t drawn = countDrawnFrames(mFilm);
    if (drawn > mDrawn) {
        mBar.advance(drawn - mDrawn);
        mDrawn = drawn;
    }
}

} // namespace shutter::film
