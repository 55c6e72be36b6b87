// SPDX-License-Identifier: MIT
#include "game/play/loop/film_writer.h"

#include "engine/io/image_file.h"
#include "game/output/render_options.h"
#include "game/output/sequence.h"

#include <system_error>

namespace shutter::game {

namespace fs = std::filesystem;

core::Result<std::unique_ptr<FilmWriter>>
FilmWriter::open(const fs::path& out, const fs::path& ffmpeg, core::FrameRate fps) {
    std::unique_ptr<FilmWriter> writer(new FilmWriter);
    writer->mPattern = out;
    writer->mFps = fps;
    if (io::lowerExtension(out) == ".mp4") {
        if (core::Status writable = io::checkFilmWritable(out); !writable)
            return core::makeError("--film: {}", writable.error().message);
        auto encoder = io::findVideoEncoder(ffmpeg);
        if (!encoder)
            return core::makeError("--film: {}", encoder.error().message);
        writer->mEncoder = std::move(encoder).value();
        writer->mFilm = out;
        writer->mPattern = filmFrames(out);
        std::error_code failure;
        fs::create_directory(writer->mPattern.parent_path(), failure);
        if (failure)
            return core::makeError(
                "--film: cannot make the folder '{}': {}",
                writer->mPattern.parent_path().string(),
                failure.message()
            );
    }
    if (core::Status writable = io::checkWritable(frameFile(writer->mPattern, 0)); !writable)
        return core::makeError("--film: {}", writable.error().message);
    return writer;
}

core::Status FilmWriter::add(const image::Image& picture) {
    if (mCount == 0) {
        mWidth = picture.width;
        mHeight = picture.height;
    }
    if (mEncoder && (mWidth % 2 != 0 || mHeight % 2 != 0))
        return core::makeError(
            "--film '{}': sides of a film are even, the window has {}x{} pixels",
            mFilm.string(),
            mWidth,
            mHeight
        );
    if (mEncoder && (picture.width != mWidth || picture.height != mHeight))
        return core::makeError(
            "--film '{}': the window changed from {}x{} to {}x{}",
            mFilm.string(),
            mWidth,
            mHeight,
            picture.width,
            picture.height
        );
    return io::writeImage(frameFile(mPattern, static_cast<int>(mCount++)), picture);
}

core::Status FilmWriter::finish() {
    if (!mEncoder || mCount == 0)
        return {};
    io::VideoFrames frames;
    frames.folder = mPattern.parent_path();
    frames.pattern = mPattern.filename().string();
    frames.count = mCount;
    frames.framesPerSecond = mFps;
    if (core::Status encoded = io::encodeVideo(*mEncoder, frames, mFilm); !encoded)
        return core::makeError("--film: {}", encoded.error().message);
    std::error_code ignored;
    for (uint32_t i = 0; i < mCount; ++i)
        fs::remove(frameFile(mPattern, static_cast<int>(i)), ignored);
    fs::remove(frames.folder, ignored); // fails if it holds other files
    return {};
}

} // namespace shutter::game
