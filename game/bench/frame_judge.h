// SPDX-License-Identifier: MIT
// Compares the pictures of one frame after another with their truths, and with the previous frame.
#pragma once

#include "engine/image/image.h"
#include "game/bench/journal.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace shutter::bench {

/// Which measures are taken of a picture.
enum class Judgement : uint8_t {
    Whole,   ///< all of them
    InTime,  ///< additional with a camera at rest: flicker
    Squares, ///< PSNR alone
};

/// A picture that was drawn of a frame.
struct FramePicture {
    std::string key;     ///< the same in every frame
    image::Image shown;  ///< as a display shows it, three channels
    image::Image linear; ///< linear light, three channels or more; empty: no HDR metric
    Judgement judgement = Judgement::Whole;
    std::filesystem::path file; ///< to be written; empty: none
    Record record;              ///< its metrics are filled in
};

class FrameJudge {
  public:
    /// Fills in the metrics of all pictures but the first, which is the truth, and writes their
    /// files. Flicker and fixed noise are there from the second frame on. Error: a file cannot be
    /// written.
    [[nodiscard]] core::Status judge(std::vector<FramePicture>& pictures);

    /// Takes a frame that was judged in an earlier run for the one before.
    /// \param shown by key, the truth's among them
    void goOnFrom(const std::string& truthKey, std::map<std::string, image::Image> shown);

  private:
    struct Before {
        image::Image shown;
        image::Image fine; ///< computeFineError(); empty where no fixed noise is measured
    };

    void judgePicture(const FramePicture& truth, FramePicture& picture, Before& kept) const;

    std::map<std::string, Before> mBefore; ///< the last frame's pictures, by key
};

} // namespace shutter::bench
