// SPDX-License-Identifier: MIT
#include "game/play/loop/picture_files.h"

#include "engine/io/image_file.h"

#include <algorithm>
#include <utility>

namespace shutter::game {

core::Status PictureFiles::open(const PlayOptions& options, double fps) {
    if (options.film.empty())
        return {};
    auto film = FilmWriter::open(options.film, options.ffmpeg, fps);
    if (!film)
        return film.error();
    mFilm = std::move(film).value();
    return {};
}

void PictureFiles::notePicture() {
    if (!wantsPicture())
        return;
    // One read-back serves all files of the frame.
    for (const auto& file : std::exchange(mScreenshots, {}))
        mWantedFiles.push_back(file);
    mWantedFiles.emplace_back();
}

core::Status PictureFiles::takePictures(PlayRenderer& renderer) {
    while (const auto picture = renderer.takePicture()) {
        image::Image opaque(picture->width, picture->height, 3);
        for (size_t i = 0; i < size_t(picture->width) * picture->height; ++i)
            std::copy_n(&picture->pixels[4 * i], 3, &opaque.pixels[3 * i]);
        SHUTTER_TRY(writePicture(opaque));
    }
    return {};
}

core::Status PictureFiles::writePicture(const image::Image& picture) {
    while (!mWantedFiles.empty()) {
        const std::filesystem::path file = std::move(mWantedFiles.front());
        mWantedFiles.pop_front();
        if (file.empty())
            break;
        SHUTTER_TRY(io::writeImage(file, picture));
    }
    return mFilm ? mFilm->add(picture) : core::Status();
}

core::Status PictureFiles::finish() {
    return mFilm ? mFilm->finish() : core::Status();
}

} // namespace shutter::game
