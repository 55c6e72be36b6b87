// SPDX-License-Identifier: MIT
// The only interface to OpenImageIO. Does not include core/result.h, because OpenImageIO's headers
// bundle a copy of fmt that conflicts with ours in one source file.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter::io::oiio {

/// Pixels as floats, row 0 at the top, interleaved.
struct FloatPixels {
    uint32_t width = 0;
    uint32_t height = 0;
    int32_t left = 0; ///< of the first pixel, in the coordinates of the display window
    int32_t top = 0;
    std::array<int32_t, 4> display{}; ///< display window: left, top, width, height
    float pixelAspect = 1.0f;         ///< width of a pixel over its height
    uint32_t channels = 0;
    std::vector<float> values;
    std::vector<std::string> channelNames;
    bool isShortInteger = false; ///< stored in 8 or 16 bits, not as floats or 32-bit integers
    /// Remainders of 32-bit integers that no float represents, over `values`; empty if there are
    /// none.
    std::vector<float> remainders;
};

struct Rgba8Pixels {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> values; ///< width * height * 4
};

enum class Storage : uint8_t { Byte, Short, Half, Float, Uint };

/// What to encode: `pixels` holds width * height * channels values of the C type of `storage`
/// (uint8_t; uint16_t; float for Half and Float; uint32_t).
struct EncodeRequest {
    std::string extension; ///< ".exr", ".png", ".jpg" or ".jpeg"
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t channels = 0;
    std::vector<std::string> channelNames; ///< empty, or one per channel
    Storage storage = Storage::Float;
    const void* pixels = nullptr;
    std::vector<std::pair<std::string, std::string>> texts; ///< of PNG: key and text
    std::optional<uint32_t> timecode; ///< of EXR: packed as SMPTE 12M-1 has it
    /// Of EXR: frames a second, numerator and denominator.
    std::optional<std::pair<int32_t, uint32_t>> frameRate;
    int jpegQuality = 0; ///< of JPEG: 1 to 100
};

/// Reads PNG, JPEG, EXR and Radiance HDR, distinguished by content: OpenImageIO reads thirty more
/// formats, but not all of its readers are robust against damaged files. Unsigned 32-bit channels
/// are not scaled (exact to 2^24); 8 and 16-bit channels are scaled to [0, 1]. Alpha is not
/// multiplied in. Refuses pictures that are too large, and those that no file of its size can hold,
/// before decoding. Returns an empty string, or why it failed.
/// \param fileBytes size of the file
/// \param begin the first bytes of the file, 16 where it has as many
[[nodiscard]] std::string readFloats(
    const std::string& path, uint64_t fileBytes, std::span<const uint8_t> begin, FloatPixels& out
);

/// Decodes PNG or JPEG bytes; refuses pictures wider or higher than `maxSide`, and those that these
/// bytes cannot hold, before decoding. Returns an empty string, or why it failed.
[[nodiscard]] std::string
decodeRgba8(std::span<const uint8_t> encoded, uint32_t maxSide, Rgba8Pixels& out);

/// The bytes of the picture's file. In memory, because libjpeg ends the process when it cannot
/// write to a file. Returns an empty string, or why it failed.
[[nodiscard]] std::string encode(const EncodeRequest& request, std::vector<uint8_t>& out);

} // namespace shutter::io::oiio
