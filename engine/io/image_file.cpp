// SPDX-License-Identifier: MIT
#include "engine/io/image_file.h"

#include "engine/core/whole_file.h"
#include "engine/io/file_bytes.h"
#include "engine/io/oiio_codec.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

namespace shutter::io {

namespace {

namespace fs = std::filesystem;

/// Larger textures are refused: no device of ours takes them, and a 100-byte file may claim them.
constexpr uint32_t kMaxTextureSide = 16384;

/// From [0, 1] to all values of the integer.
template <class Integer> Integer toInteger(float value) {
    if (!(value > 0.0f))
        return 0; // NaN too
    constexpr auto kMax = float(std::numeric_limits<Integer>::max());
    return Integer(std::lround(std::min(value, 1.0f) * kMax));
}

uint32_t toUint(float value) {
    if (!(value > 0.0f))
        return 0; // NaN too
    constexpr double kMax = 4294967295.0;
    return uint32_t(std::min(std::round(double(value)), kMax));
}

/// Display formats hold one or three channels.
template <class Integer>
std::vector<Integer> packIntegers(const image::Image& image, uint32_t channels) {
    const size_t count = size_t(image.width) * image.height;
    std::vector<Integer> packed(count * channels);
    for (size_t i = 0; i < count; ++i) {
        for (uint32_t c = 0; c < channels; ++c) {
            packed[i * channels + c] = toInteger<Integer>(image.pixels[i * image.channels + c]);
        }
    }
    return packed;
}

/// Bits per channel of the formats for display: 8 or 16.
enum class DisplayDepth : uint8_t { Bytes, Deep };

/// Two decimal digits, four bits each.
uint32_t packDigits(uint32_t number) {
    return number / 10 << 4 | number % 10;
}

/// A byte each, the frames in the lowest.
uint32_t pack(const Timecode& timecode) {
    return packDigits(timecode.hours) << 24 | packDigits(timecode.minutes) << 16 |
           packDigits(timecode.seconds) << 8 | packDigits(timecode.frames);
}

/// Encoding choices that a format leaves open.
struct Encoding {
    SampleType type = SampleType::Float;
    DisplayDepth depth = DisplayDepth::Bytes;
    int jpegQuality = kJpegQuality;
    std::span<const PictureText> texts{};
    const FrameStamp* stamp = nullptr; ///< null: none
};

std::string encode(
    const fs::path& path,
    const image::Image& image,
    const Encoding& encoding,
    std::vector<uint8_t>& out
) {
    oiio::EncodeRequest request;
    for (const PictureText& one : encoding.texts)
        request.texts.emplace_back(one.key, one.text);
    request.jpegQuality = encoding.jpegQuality;
    request.extension = lowerExtension(path);
    request.width = image.width;
    request.height = image.height;
    if (isDisplayFormat(path).value()) {
        request.channels = image.channels >= 3 ? 3 : 1;
        if (encoding.depth == DisplayDepth::Deep) {
            request.storage = oiio::Storage::Short;
            const auto deep = packIntegers<uint16_t>(image, request.channels);
            request.pixels = deep.data();
            return oiio::encode(request, out);
        }
        request.storage = oiio::Storage::Byte;
        const auto bytes = packIntegers<uint8_t>(image, request.channels);
        request.pixels = bytes.data();
        return oiio::encode(request, out);
    }
    if (encoding.stamp) {
        if (encoding.stamp->timecode)
            request.timecode = pack(*encoding.stamp->timecode);
        if (const auto rate = core::findRational(encoding.stamp->rate))
            request.frameRate = {rate->numerator, rate->denominator};
    }
    request.channels = image.channels;
    request.channelNames = image.channelNames;
    if (encoding.type == SampleType::Uint) {
        request.storage = oiio::Storage::Uint;
        std::vector<uint32_t> integers(image.pixels.size());
        std::transform(image.pixels.begin(), image.pixels.end(), integers.begin(), toUint);
        request.pixels = integers.data();
        return oiio::encode(request, out);
    }
    request.storage =
        encoding.type == SampleType::Half ? oiio::Storage::Half : oiio::Storage::Float;
    request.pixels = image.pixels.data();
    return oiio::encode(request, out);
}

image::Image
cropImage(const image::Image& all, uint32_t left, uint32_t top, uint32_t width, uint32_t height) {
    image::Image cropped(width, height, all.channels);
    cropped.channelNames = all.channelNames;
    const size_t rowValues = size_t(width) * all.channels;
    for (uint32_t y = 0; rowValues > 0 && y < height; ++y) {
        const size_t first = (size_t(top) + y) * all.width + left;
        std::copy_n(&all.pixels[first * all.channels], rowValues, &cropped.pixels[y * rowValues]);
    }
    return cropped;
}

void checkImage(const image::Image& image) {
    SHUTTER_CHECK(
        image.pixels.size() == size_t(image.width) * image.height * image.channels,
        "{}x{}x{} with {} values",
        image.width,
        image.height,
        image.channels,
        image.pixels.size()
    );
    SHUTTER_CHECK(
        image.channelNames.empty() || image.channelNames.size() == image.channels,
        "{} names for {} channels",
        image.channelNames.size(),
        image.channels
    );
}

} // namespace

std::string lowerExtension(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
        return char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    });
    return extension;
}

core::Result<image::Image> readImage(const fs::path& path) {
    core::Result<StoredImage> stored = readStoredImage(path);
    if (!stored)
        return stored.error();
    return std::move(stored.value().image);
}

core::Result<StoredImage> readStoredImage(const fs::path& path) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
        return core::makeError("cannot read '{}': no such file", path.string());
    }
    if (!fs::is_regular_file(path, ignored)) {
        return core::makeError("cannot read '{}': it is not a file", path.string());
    }
    constexpr uint64_t kSignatureBytes = 16;
    const auto begin = readFileBytes(path, kSignatureBytes);
    if (!begin)
        return core::makeError("cannot read '{}': permission denied", path.string());
    oiio::FloatPixels pixels;
    const std::string why =
        oiio::readFloats(path.string(), fs::file_size(path, ignored), begin.value(), pixels);
    if (!why.empty())
        return core::makeError("cannot read '{}': {}", path.string(), why);
    StoredImage stored;
    stored.image.width = pixels.width;
    stored.image.height = pixels.height;
    stored.image.channels = pixels.channels;
    stored.image.pixels = std::move(pixels.values);
    stored.image.channelNames = std::move(pixels.channelNames);
    stored.isDisplayEncoded = pixels.isShortInteger;
    if (!pixels.remainders.empty()) {
        stored.remainder = image::Image(pixels.width, pixels.height, pixels.channels);
        stored.remainder.pixels = std::move(pixels.remainders);
    }
    stored.data = {pixels.left, pixels.top, pixels.width, pixels.height};
    const auto [left, top, width, height] = pixels.display;
    stored.display = {left, top, uint32_t(width), uint32_t(height)};
    stored.pixelAspect = pixels.pixelAspect;
    return stored;
}

void cropToDisplay(StoredImage& stored) {
    const PixelWindow& data = stored.data;
    const PixelWindow& display = stored.display;
    PixelWindow inside{std::max(data.x, display.x), std::max(data.y, display.y)};
    const auto length = [](int64_t begin, int64_t end) {
        return uint32_t(std::max(end - begin, int64_t(0)));
    };
    inside.width = length(inside.x, std::min(data.x + data.width, display.x + display.width));
    inside.height = length(inside.y, std::min(data.y + data.height, display.y + display.height));
    if (inside == data)
        return;
    const uint32_t left = uint32_t(inside.x - data.x);
    const uint32_t top = uint32_t(inside.y - data.y);
    stored.image = cropImage(stored.image, left, top, inside.width, inside.height);
    if (!stored.remainder.pixels.empty())
        stored.remainder = cropImage(stored.remainder, left, top, inside.width, inside.height);
    stored.data = inside;
}

core::Result<bool> isDisplayFormat(const fs::path& path, std::string_view known) {
    const std::string extension = lowerExtension(path);
    if (extension == ".exr")
        return false;
    if (extension == ".png" || extension == ".jpg" || extension == ".jpeg")
        return true;
    return core::makeError(
        "'{}' has the unknown extension '{}': use {}", path.string(), extension, known
    );
}

core::Status checkWritable(const fs::path& path) {
    const core::Result<bool> known = isDisplayFormat(path);
    if (!known)
        return known.error();
    if (const core::Status able = core::checkOutput(path); !able)
        return core::makeError("cannot write '{}': {}", path.string(), able.error().message);
    return {};
}

namespace {

core::Result<std::vector<uint8_t>>
encode(const fs::path& path, const image::Image& image, const Encoding& encoding) {
    if (image.width == 0 || image.height == 0 || image.channels == 0)
        return core::makeError("cannot write '{}': the picture has no pixels", path.string());
    std::vector<uint8_t> bytes;
    const std::string why = encode(path, image, encoding, bytes);
    if (!why.empty())
        return core::makeError("cannot write '{}': {}", path.string(), why);
    return bytes;
}

core::Status write(const fs::path& path, const image::Image& image, const Encoding& encoding) {
    checkImage(image);
    if (const core::Status writable = checkWritable(path); !writable)
        return writable;
    const auto bytes = encode(path, image, encoding);
    return bytes ? writeFileBytes(path, bytes.value()) : core::Status(bytes.error());
}

} // namespace

core::Status writeImage(const fs::path& path, const image::Image& image, SampleType type) {
    return write(path, image, {.type = type});
}

core::Result<std::vector<uint8_t>>
encodeImage(const fs::path& fileName, const image::Image& image, SampleType type, int jpegQuality) {
    checkImage(image);
    SHUTTER_CHECK(jpegQuality >= 1 && jpegQuality <= 100, "{}", jpegQuality);
    if (const auto known = isDisplayFormat(fileName); !known)
        return known.error();
    return encode(fileName, image, {.type = type, .jpegQuality = jpegQuality});
}

core::Status writeDeepPng(const fs::path& path, const image::Image& image) {
    SHUTTER_CHECK(lowerExtension(path) == ".png", "'{}' is no PNG", path.string());
    return write(path, image, {.depth = DisplayDepth::Deep});
}

core::Status writePngWithTexts(
    const fs::path& path, const image::Image& image, std::span<const PictureText> texts
) {
    SHUTTER_CHECK(lowerExtension(path) == ".png", "'{}' is no PNG", path.string());
    return write(path, image, {.texts = texts});
}

core::Status
writeStampedImage(const fs::path& path, const image::Image& image, const FrameStamp& stamp) {
    SHUTTER_CHECK(lowerExtension(path) == ".exr", "'{}' is no EXR", path.string());
    if (const auto& timecode = stamp.timecode)
        SHUTTER_CHECK(
            timecode->hours < 24 && timecode->minutes < 60 && timecode->seconds < 60 &&
                timecode->frames < kMaxTimecodeRate,
            "{}:{}:{}:{}",
            timecode->hours,
            timecode->minutes,
            timecode->seconds,
            timecode->frames
        );
    return write(path, image, {.stamp = &stamp});
}

core::Result<scene::TextureImage>
decodeTexture(std::span<const uint8_t> encoded, const std::string& label) {
    if (encoded.empty())
        return core::makeError("cannot decode {}: it is empty", label);
    oiio::Rgba8Pixels pixels;
    const std::string why = oiio::decodeRgba8(encoded, kMaxTextureSide, pixels);
    if (!why.empty())
        return core::makeError("cannot decode {}: {}", label, why);
    scene::TextureImage texture;
    texture.name = label;
    texture.width = pixels.width;
    texture.height = pixels.height;
    texture.rgba = std::move(pixels.values);
    return texture;
}

} // namespace shutter::io
