// SPDX-License-Identifier: MIT
#include "game/play/loop/picture_files.h"

#include "engine/core/words.h"
#include "game/play/loop/numbered_file.h"

#include <algorithm>
#include <utility>

namespace shutter::game {

core::Status PictureFiles::open(const PlayOptions& options, core::FrameRate fps) {
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
    mWanted.push_back(std::exchange(mNext, {}));
}

bool PictureFiles::wantsPhoto() const {
    return std::any_of(mNext.begin(), mNext.end(), [](const auto& file) { return file.isPhoto; });
}

std::vector<std::filesystem::path> PictureFiles::listPendingPhotos() const {
    std::vector<std::filesystem::path> pending;
    const auto add = [&](const std::vector<PictureFile>& files) {
        for (const PictureFile& file : files)
            if (file.isPhoto)
                pending.push_back(file.path);
    };
    add(mNext);
    std::for_each(mWanted.begin(), mWanted.end(), add);
    return pending;
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
    if (!mWanted.empty()) {
        const std::vector<PictureFile> files = std::move(mWanted.front());
        mWanted.pop_front();
        for (const PictureFile& file : files)
            SHUTTER_TRY(writeFile(file, picture));
    }
    return mFilm ? mFilm->add(picture) : core::Status();
}

core::Status PictureFiles::writeFile(const PictureFile& file, const image::Image& picture) {
    if (!file.isPhoto)
        return io::writeImage(file.path, picture);
    const core::Status written = io::writePngWithTexts(file.path, picture, file.texts);
    mNews = written ? "saved " + file.path.string() : written.error().message;
    return {};
}

core::Status PictureFiles::finish() {
    return mFilm ? mFilm->finish() : core::Status();
}

core::Result<std::filesystem::path> choosePhotoFile(
    const std::string& title,
    const PlaySettings& settings,
    std::span<const std::filesystem::path> taken
) {
    const std::string stem = std::filesystem::path(title).stem().string();
    return findFreeFile(".", fmt::format("{}_{}", stem, settings.method), ".png", taken);
}

std::vector<io::PictureText> describePhoto(
    const std::string& title,
    const PlaySettings& settings,
    double seconds,
    std::optional<uint32_t> rays
) {
    std::string description = fmt::format("{} at {:.3f} s, {}", title, seconds, settings.method);
    if (rays)
        description += fmt::format(", {} per pixel", core::countOf(*rays, "ray"));
    return {
        {"Software", "shutter play"},
        {"Description", std::move(description)},
        {"Settings", formatPlaySettings(settings)}};
}

} // namespace shutter::game
