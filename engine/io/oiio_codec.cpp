// SPDX-License-Identifier: MIT
#include "engine/io/oiio_codec.h"

#include "engine/io/exr_header.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <fstream>
#include <istream>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>

namespace shutter::io::oiio {

namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Largest side of a picture that readFloats takes; bounds the memory that a damaged header can
/// request.
constexpr int kMaxFloatSide = 65536;
constexpr uint64_t kMaxFloatValues = uint64_t(1) << 31; // 8 GiB

/// Maximum number of values per byte of a file, rounded up: deflate expands a byte to 1032 bytes,
/// in which an EXR's DWA stores an 8x8 block in two bytes and a PNG 8 pixels in one.
constexpr uint64_t kMaxFloatsPerByte = 65536;
constexpr uint64_t kMaxPixelsPerByte = 8 * 1032 + 64;

/// libjpeg's JPEG_MAX_DIMENSION; above it, libjpeg ends the process.
constexpr uint32_t kMaxJpegSide = 65500;

/// OpenImageIO's messages may span lines; the person at the terminal gets one sentence.
std::string oneLine(std::string text, const char* fallback) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '.' || text.back() == ' ')) {
        text.pop_back();
    }
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.empty() ? std::string(fallback) : text;
}

/// Values as stored: no multiplication by alpha.
ImageSpec makeReadConfig() {
    ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    return config;
}

bool hasUintChannel(const ImageSpec& spec) {
    if (spec.format == TypeDesc::UINT32)
        return true;
    return std::any_of(spec.channelformats.begin(), spec.channelformats.end(), [](TypeDesc t) {
        return t == TypeDesc::UINT32;
    });
}

/// OpenImageIO would divide unsigned integers by their largest value; an id must stay an id.
bool readChannelByChannel(ImageInput& input, const ImageSpec& spec, FloatPixels& out) {
    const size_t count = size_t(spec.width) * size_t(spec.height);
    const size_t channels = size_t(spec.nchannels);
    std::vector<float> floats(count);
    std::vector<uint32_t> integers(count);
    for (size_t c = 0; c < channels; ++c) {
        const int channel = int(c);
        const bool isUint = spec.channelformat(channel) == TypeDesc::UINT32;
        void* data = isUint ? static_cast<void*>(integers.data()) : floats.data();
        const TypeDesc type = isUint ? TypeDesc::UINT32 : TypeDesc::FLOAT;
        if (!input.read_image(0, 0, channel, channel + 1, type, data))
            return false;
        for (size_t i = 0; i < count; ++i) {
            const float value = isUint ? float(integers[i]) : floats[i];
            out.values[i * channels + c] = value;
            if (!isUint || double(value) == double(integers[i]))
                continue;
            out.remainders.resize(out.values.size(), 0.0f);
            out.remainders[i * channels + c] = float(double(integers[i]) - double(value));
        }
    }
    return true;
}

/// A picture of so many values or pixels cannot come from so many bytes.
std::string refuseClaim(const ImageSpec& spec, uint64_t bytes) {
    return "it claims " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
           " pixels in " + std::to_string(bytes) + " bytes";
}

/// Formats other than EXR have no windows: what readers make of their resolutions and offsets, no
/// viewer goes by.
void readWindows(const ImageInput& input, const ImageSpec& spec, FloatPixels& out) {
    out.display = {0, 0, spec.width, spec.height};
    if (std::string_view(input.format_name()) != "openexr")
        return;
    out.left = spec.x;
    out.top = spec.y;
    out.display = {spec.full_x, spec.full_y, spec.full_width, spec.full_height};
    out.pixelAspect = spec.get_float_attribute("PixelAspectRatio", 1.0f);
}

std::string readOpened(ImageInput& input, uint64_t fileBytes, FloatPixels& out) {
    const ImageSpec spec = input.spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1 || spec.deep) {
        return "it is not a flat picture";
    }
    const uint64_t count = uint64_t(spec.width) * uint64_t(spec.height) * uint64_t(spec.nchannels);
    if (spec.width > kMaxFloatSide || spec.height > kMaxFloatSide || count > kMaxFloatValues) {
        return "it is too large (" + std::to_string(spec.width) + "x" +
               std::to_string(spec.height) + ")";
    }
    if (count / kMaxFloatsPerByte > fileBytes)
        return refuseClaim(spec, fileBytes);
    out.width = uint32_t(spec.width);
    out.height = uint32_t(spec.height);
    out.channels = uint32_t(spec.nchannels);
    readWindows(input, spec, out);
    out.channelNames.assign(spec.channelnames.begin(), spec.channelnames.end());
    out.isShortInteger = spec.format == TypeDesc::UINT8 || spec.format == TypeDesc::UINT16;
    out.values.resize(count);
    const bool done =
        hasUintChannel(spec)
            ? readChannelByChannel(input, spec, out)
            : input.read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, out.values.data());
    return done ? std::string() : oneLine(input.geterror(), "its pixels cannot be decoded");
}

/// Signature of a file format, and OpenImageIO's name of its reader.
struct Signature {
    std::string_view begin;
    const char* reader;
};

using namespace std::string_view_literals;

constexpr Signature kTextureSignatures[] = {
    {"\x89PNG\r\n\x1A\n"sv, "png"},
    {"\xFF\xD8\xFF"sv, "jpeg"},
};
constexpr Signature kFloatSignatures[] = {
    {"\x76\x2F\x31\x01"sv, "openexr"},
    {"#?RADIANCE"sv, "hdr"},
    {"#?RGBE"sv, "hdr"},
};

const char* findReader(std::span<const uint8_t> file, std::span<const Signature> signatures) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    for (const Signature& signature : signatures)
        if (text.starts_with(signature.begin))
            return signature.reader;
    return nullptr;
}

/// True when every chunk up to IEND is there. OpenImageIO leaks memory when libpng runs into the
/// end of the bytes, and its message for that names no cause.
bool isPngComplete(std::istream& stream, uint64_t size) {
    constexpr uint64_t kSignatureBytes = 8;
    constexpr uint64_t kChunkOverhead = 12; // length, type, checksum
    uint64_t offset = kSignatureBytes;
    while (size >= offset + kChunkOverhead) {
        std::array<uint8_t, 8> chunk{};
        stream.seekg(std::streamoff(offset));
        stream.read(reinterpret_cast<char*>(chunk.data()), std::streamsize(chunk.size()));
        const uint64_t length = uint64_t(chunk[0]) << 24 | uint64_t(chunk[1]) << 16 |
                                uint64_t(chunk[2]) << 8 | uint64_t(chunk[3]);
        if (!stream || length > size - offset - kChunkOverhead)
            return false;
        if (std::memcmp(chunk.data() + 4, "IEND", 4) == 0)
            return true;
        offset += kChunkOverhead + length;
    }
    return false;
}

/// Checks a file before it is opened. Returns an empty string or an error message.
std::string checkFile(const char* reader, const std::string& path, uint64_t fileBytes) {
    const std::string_view name = reader;
    if (name == "openexr")
        return checkExrHeader(path, fileBytes, kMaxFloatSide);
    std::ifstream stream(path, std::ios::binary);
    return name != "png" || isPngComplete(stream, fileBytes) ? "" : "the PNG is cut off";
}

/// 1 to 4 channels (grey, grey and alpha, RGB, RGBA) to RGBA.
void expandToRgba(const std::vector<uint8_t>& source, size_t channels, std::vector<uint8_t>& rgba) {
    const size_t count = source.size() / channels;
    rgba.resize(count * 4);
    const bool isGrey = channels <= 2;
    const bool hasAlpha = channels == 2 || channels == 4;
    for (size_t i = 0; i < count; ++i) {
        const uint8_t* in = source.data() + i * channels;
        uint8_t* out = rgba.data() + i * 4;
        out[0] = in[0];
        out[1] = isGrey ? in[0] : in[1];
        out[2] = isGrey ? in[0] : in[2];
        out[3] = hasAlpha ? in[channels - 1] : uint8_t(255);
    }
}

std::string
decodeOpened(ImageInput& input, uint64_t encodedBytes, uint32_t maxSide, Rgba8Pixels& out) {
    const ImageSpec spec = input.spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels < 1 || spec.nchannels > 4) {
        return "it has no pixels or an unknown channel layout";
    }
    if (uint32_t(spec.width) > maxSide || uint32_t(spec.height) > maxSide) {
        return "it is " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
               " pixels, above the limit of " + std::to_string(maxSide) + "x" +
               std::to_string(maxSide);
    }
    if (uint64_t(spec.width) * uint64_t(spec.height) / kMaxPixelsPerByte > encodedBytes)
        return refuseClaim(spec, encodedBytes);
    const size_t channels = size_t(spec.nchannels);
    std::vector<uint8_t> stored(size_t(spec.width) * size_t(spec.height) * channels);
    if (!input.read_image(0, 0, 0, spec.nchannels, TypeDesc::UINT8, stored.data())) {
        return oneLine(input.geterror(), "its pixels cannot be decoded");
    }
    out.width = uint32_t(spec.width);
    out.height = uint32_t(spec.height);
    if (channels == 4) {
        out.values = std::move(stored);
    } else {
        expandToRgba(stored, channels, out.values);
    }
    return {};
}

ImageSpec makeWriteSpec(const EncodeRequest& request, TypeDesc memoryType) {
    const TypeDesc stored =
        request.storage == Storage::Half ? TypeDesc(TypeDesc::HALF) : memoryType;
    ImageSpec spec(int(request.width), int(request.height), int(request.channels), stored);
    if (!request.channelNames.empty()) {
        spec.channelnames.assign(request.channelNames.begin(), request.channelNames.end());
    }
    const auto alpha = std::find(request.channelNames.begin(), request.channelNames.end(), "A");
    spec.alpha_channel =
        alpha == request.channelNames.end() ? -1 : int(alpha - request.channelNames.begin());
    spec.z_channel = -1;
    if (request.storage == Storage::Byte || request.storage == Storage::Short) {
        spec.attribute("oiio:ColorSpace", "sRGB");
        spec.attribute("Compression", "jpeg:" + std::to_string(request.jpegQuality));
        spec.attribute("CompressionQuality", request.jpegQuality);
        for (const auto& [key, text] : request.texts)
            spec.attribute(key, text);
    } else {
        spec.attribute("oiio:ColorSpace", "Linear");
        spec.attribute("compression", "zip");
        // Or OpenImageIO stamps the time into the file: the same picture shall be the same bytes.
        spec.attribute("DateTime", "1970:01:01 00:00:00");
        if (request.timecode) {
            const std::array<uint32_t, 2> words = {*request.timecode, 0}; // no user data
            spec.attribute("smpte:TimeCode", OIIO::TypeTimeCode, words.data());
        }
        if (request.frameRate) {
            const std::array<int32_t, 2> terms = {
                request.frameRate->first, int32_t(request.frameRate->second)};
            // OpenEXR's name: OpenImageIO 2.4 writes its own name, FramesPerSecond, as another
            // attribute.
            spec.attribute("framesPerSecond", OIIO::TypeRational, terms.data());
        }
    }
    return spec;
}

TypeDesc memoryTypeOf(Storage storage) {
    switch (storage) {
    case Storage::Byte:
        return TypeDesc::UINT8;
    case Storage::Short:
        return TypeDesc::UINT16;
    case Storage::Uint:
        return TypeDesc::UINT32;
    case Storage::Half:
    case Storage::Float:
        break;
    }
    return TypeDesc::FLOAT;
}

} // namespace

std::string readFloats(
    const std::string& path, uint64_t fileBytes, std::span<const uint8_t> begin, FloatPixels& out
) try {
    const char* reader = findReader(begin, kTextureSignatures);
    if (!reader)
        reader = findReader(begin, kFloatSignatures);
    if (!reader)
        return "it is neither PNG, JPEG, EXR nor HDR";
    if (std::string wrong = checkFile(reader, path, fileBytes); !wrong.empty())
        return wrong;
    // By the reader's name: open() would try all the others where this one fails.
    const auto input = ImageInput::create(reader);
    ImageSpec spec;
    if (!input || !input->open(path, spec, makeReadConfig()))
        return oneLine(
            input ? input->geterror() : OIIO::geterror(), "its header cannot be decoded"
        );
    const std::string why = readOpened(*input, fileBytes, out);
    input->close();
    return why;

} catch (const std::exception& e) {

    return oneLine(e.what(), "the decoder failed");
}

std::string decodeRgba8(std::span<const uint8_t> encoded, uint32_t maxSide, Rgba8Pixels& out) try {
    const char* reader = findReader(encoded, kTextureSignatures);
    if (!reader)
        return "it is neither PNG nor JPEG";
    if (std::string_view(reader) == "png") {
        const auto* text = reinterpret_cast<const char*>(encoded.data());
        std::istringstream stream(std::string(text, encoded.size()));
        if (!isPngComplete(stream, encoded.size()))
            return "the PNG is cut off";
    }
    OIIO::Filesystem::IOMemReader memory(encoded.data(), encoded.size());
    ImageSpec config = makeReadConfig();
    OIIO::Filesystem::IOProxy* proxy = &memory;
    config.attribute("oiio:ioproxy", TypeDesc::PTR, &proxy);
    const auto input = ImageInput::create(reader);
    ImageSpec spec;
    if (!input || !input->open("memory", spec, config))
        return oneLine(
            input ? input->geterror() : OIIO::geterror(), "its header cannot be decoded"
        );
    const std::string why = decodeOpened(*input, encoded.size(), maxSide, out);
    input->close();
    return why;

} catch (const std::exception& e) {

    return oneLine(e.what(), "the decoder failed");
}

std::string encode(const EncodeRequest& request, std::vector<uint8_t>& out) try {
    const bool isJpeg = request.extension == ".jpg" || request.extension == ".jpeg";
    if (isJpeg && std::max(request.width, request.height) > kMaxJpegSide) {
        return "JPEG ends at " + std::to_string(kMaxJpegSide) + " pixels a side";
    }
    const std::string name = "memory" + request.extension;
    const auto output = ImageOutput::create(name);
    if (!output)
        return oneLine(OIIO::geterror(), "no writer knows this format");
    if (!output->supports("ioproxy"))
        return "this OpenImageIO cannot encode it in memory";
    const TypeDesc memoryType = memoryTypeOf(request.storage);
    OIIO::Filesystem::IOVecOutput memory(out);
    output->set_ioproxy(&memory);
    if (!output->open(name, makeWriteSpec(request, memoryType)))
        return oneLine(output->geterror(), "the encoder cannot be opened");
    if (!output->write_image(memoryType, request.pixels))
        return oneLine(output->geterror(), "encoding failed");
    if (!output->close())
        return oneLine(output->geterror(), "encoding failed at the end");
    return {};

} catch (const std::exception& e) {

    return oneLine(e.what(), "the encoder failed");
}

} // namespace shutter::io::oiio
