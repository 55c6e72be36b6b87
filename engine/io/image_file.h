// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/frame_rate.h"
#include "engine/core/result.h"
#include "engine/image/image.h"
#include "engine/scene/assets.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::io {

/// The extension in lower case: ".png" for "a.PNG".
[[nodiscard]] std::string lowerExtension(const std::filesystem::path& path);

/// Reads a PNG, JPEG, EXR or Radiance HDR, distinguished by content, as floats (8-bit formats:
/// value / 255, not linearised). For an EXR, the pixels of the data window; readStoredImage() also
/// returns its position. Error: names the file and why.
[[nodiscard]] core::Result<image::Image> readImage(const std::filesystem::path& path);

/// A rectangle of pixels; x to the right, y down.
struct PixelWindow {
    int64_t x = 0;
    int64_t y = 0;
    uint32_t width = 0;
    uint32_t height = 0;

    bool operator==(const PixelWindow&) const = default;
};

/// A picture with its file's metadata on value encoding and placement.
struct StoredImage {
    image::Image image;            ///< the pixels that there are: those of the data window
    bool isDisplayEncoded = false; ///< 8 or 16 bits: sRGB; else (EXR, HDR) linear light, or data
    /// Remainders of whole numbers above 2^24, which were rounded to floats in `image`; empty if
    /// all values are exact.
    image::Image remainder{};
    PixelWindow data;         ///< where in the picture the pixels lie
    PixelWindow display;      ///< the picture; only an EXR's may differ from `data`
    float pixelAspect = 1.0f; ///< width of a pixel over its height
};

/// As readImage.
[[nodiscard]] core::Result<StoredImage> readStoredImage(const std::filesystem::path& path);

/// Leaves out the pixels outside of the display window: `data` lies inside it then, and has no
/// pixels where none of them did.
void cropToDisplay(StoredImage& stored);

/// True where the extension stores values in [0, 1] for display (.png .jpg .jpeg), false for .exr.
/// An Error names the extension when it is neither.
/// \param known the extensions that the error offers: the caller may take more, or fewer
[[nodiscard]] core::Result<bool>
isDisplayFormat(const std::filesystem::path& path, std::string_view known = ".exr, .png or .jpg");

/// Checks, before hours of rendering, that `path` has a known extension and that its folder exists
/// and can be written.
[[nodiscard]] core::Status checkWritable(const std::filesystem::path& path);

/// How EXR channels are stored.
enum class SampleType : uint8_t { Half, Float, Uint };

/// Default quality of a JPEG, 1 to 100.
inline constexpr int kJpegQuality = 95;

/// Writes .exr (as `type`), .png (8 bit) or .jpg (8 bit, kJpegQuality). Written to a temporary file
/// in the same folder and renamed, so that an interrupted write never leaves a partial file under
/// this name. PNG and JPEG take the first three channels (or one) and clamp to [0, 1].
[[nodiscard]] core::Status writeImage(
    const std::filesystem::path& path,
    const image::Image& image,
    SampleType type = SampleType::Float
);

/// The bytes of the file that writeImage() would write.
/// \param fileName its extension selects the format
/// \param jpegQuality 1 to 100; other formats do not use it
[[nodiscard]] core::Result<std::vector<uint8_t>> encodeImage(
    const std::filesystem::path& fileName,
    const image::Image& image,
    SampleType type = SampleType::Float,
    int jpegQuality = kJpegQuality
);

/// writeImage() of a .png (CHECKed) of 16 bits per channel.
[[nodiscard]] core::Status
writeDeepPng(const std::filesystem::path& path, const image::Image& image);

/// Hours, minutes, seconds and frames of a picture in a sequence; no frame numbers are dropped.
struct Timecode {
    uint32_t hours = 0;   ///< below 24
    uint32_t minutes = 0; ///< below 60
    uint32_t seconds = 0; ///< below 60
    uint32_t frames = 0;  ///< below kMaxTimecodeRate

    bool operator==(const Timecode&) const = default;
};

/// Frames that a second of a picture's time code may have.
inline constexpr uint32_t kMaxTimecodeRate = 30;

/// Time metadata of a picture of a sequence.
struct FrameStamp {
    core::FrameRate rate;
    std::optional<Timecode> timecode{};
};

/// writeImage() of a .exr (CHECKed) as floats, with the attributes `framesPerSecond`, unless the
/// rate is too large or small for one, and `timeCode` (CHECKed).
[[nodiscard]] core::Status writeStampedImage(
    const std::filesystem::path& path, const image::Image& image, const FrameStamp& stamp
);

/// A key of at most 79 letters and its text in a PNG file (tEXt).
struct PictureText {
    std::string key;
    std::string text;
};

/// writeImage() of a .png (CHECKed) with texts.
[[nodiscard]] core::Status writePngWithTexts(
    const std::filesystem::path& path, const image::Image& image, std::span<const PictureText> texts
);

/// Decodes an encoded PNG or JPEG held in memory to 8-bit RGBA.
/// \param label names the picture in the error, e.g. "image 3 (wood.png)"
[[nodiscard]] core::Result<scene::TextureImage>
decodeTexture(std::span<const uint8_t> encoded, const std::string& label);

} // namespace shutter::io
