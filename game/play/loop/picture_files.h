// SPDX-License-Identifier: MIT
// The pictures of a session that become files: screenshots and the film.
#pragma once

#include "game/play/loop/film_writer.h"
#include "game/play/loop/play_options.h"
#include "game/play/loop/play_renderer.h"

#include <deque>
#include <filesystem>
#include <memory>
#include <vector>

namespace shutter::game {

class PictureFiles {
  public:
    /// Opens the film that --film names, if any. \param fps its frames per second, above 0
    /// Error: FilmWriter::open()'s.
    [[nodiscard]] core::Status open(const PlayOptions& options, double fps);

    [[nodiscard]] bool isFilming() const { return mFilm != nullptr; }

    /// Asks for the next picture as a file of its own.
    void addScreenshot(const std::filesystem::path& file) { mScreenshots.push_back(file); }

    /// Whether the next picture must be read back.
    [[nodiscard]] bool wantsPicture() const { return mFilm || !mScreenshots.empty(); }

    /// To be called once the next picture was submitted, read back if wantsPicture() said so.
    void notePicture();

    /// Writes the pictures that the renderer has finished.
    [[nodiscard]] core::Status takePictures(PlayRenderer& renderer);

    /// Makes the film, of whose pictures all were taken.
    [[nodiscard]] core::Status finish();

  private:
    core::Status writePicture(const image::Image& picture);

    std::vector<std::filesystem::path> mScreenshots; ///< files of the next picture
    /// Files of the pictures being read back, in order; an empty name ends a picture's list.
    std::deque<std::filesystem::path> mWantedFiles;
    std::unique_ptr<FilmWriter> mFilm;
};

} // namespace shutter::game
