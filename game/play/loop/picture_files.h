// SPDX-License-Identifier: MIT
// The pictures of a session that become files: screenshots, photos and the film.
#pragma once

#include "engine/core/result.h"
#include "engine/io/image_file.h"
#include "game/play/loop/film_writer.h"
#include "game/play/loop/play_options.h"
#include "game/play/loop/play_renderer.h"
#include "game/play/panel/play_settings.h"

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter::game {

class PictureFiles {
  public:
    /// Opens the film that --film names, if any. \param fps its frames per second
    /// Error: FilmWriter::open()'s.
    [[nodiscard]] core::Status open(const PlayOptions& options, core::FrameRate fps);

    [[nodiscard]] bool isFilming() const { return mFilm != nullptr; }

    /// Requests the next picture as a separate file.
    void addScreenshot(const std::filesystem::path& file) { mNext.push_back({file, {}, false}); }

    /// Requests the next picture as a PNG file without overlays.
    /// \param texts that the file holds
    void addPhoto(const std::filesystem::path& file, std::vector<io::PictureText> texts) {
        mNext.push_back({file, std::move(texts), true});
    }

    /// Forgets the files of the next picture.
    void dropRequests() { mNext.clear(); }

    /// Whether the next picture must be read back.
    [[nodiscard]] bool wantsPicture() const { return mFilm || !mNext.empty(); }

    /// Whether the next picture is a photo.
    [[nodiscard]] bool wantsPhoto() const;

    /// To be called once the next picture was submitted, read back if wantsPicture() returned true.
    void notePicture();

    /// Files of requested photos that are not written yet.
    [[nodiscard]] std::vector<std::filesystem::path> listPendingPhotos() const;

    /// Message to the player about the last written photo; empty if there was none since the last
    /// call.
    [[nodiscard]] std::string takeNews() { return std::exchange(mNews, {}); }

    /// Writes the pictures that the renderer has finished. Error: a screenshot or the film cannot
    /// be written; for photos see takeNews().
    [[nodiscard]] core::Status takePictures(PlayRenderer& renderer);

    /// Makes the film, of whose pictures all were taken.
    [[nodiscard]] core::Status finish();

  private:
    struct PictureFile {
        std::filesystem::path path;
        std::vector<io::PictureText> texts;
        bool isPhoto = false;
    };

    core::Status writePicture(const image::Image& picture);
    core::Status writeFile(const PictureFile& file, const image::Image& picture);

    std::vector<PictureFile> mNext;               ///< of the next picture
    std::deque<std::vector<PictureFile>> mWanted; ///< of the pictures being read back, in order
    std::string mNews;
    std::unique_ptr<FilmWriter> mFilm;
};

/// A file of the current folder that is not there yet: "rally_truth_001.png".
/// \param title of the stage, a demo's name or a file's
/// \param taken files that will be there soon
[[nodiscard]] core::Result<std::filesystem::path> choosePhotoFile(
    const std::string& title,
    const PlaySettings& settings,
    std::span<const std::filesystem::path> taken
);

/// \param seconds of the picture \param rays per pixel so far, where it is traced
[[nodiscard]] std::vector<io::PictureText> describePhoto(
    const std::string& title,
    const PlaySettings& settings,
    double seconds,
    std::optional<uint32_t> rays
);

} // namespace shutter::game
