// SPDX-License-Identifier: MIT
#include "engine/io/exr_header.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <ios>
#include <iterator>
#include <string_view>

namespace shutter::io {

namespace {

constexpr uint32_t kDeepBit = 0x800;
constexpr uint32_t kManyPartsBit = 0x1000;
constexpr size_t kMaxNameBytes = 255;
/// Size of a tile's entry in the table of offsets, which follows the header.
constexpr uint64_t kOffsetBytes = 8;
constexpr uint64_t kMaxTilePixels = uint64_t(1) << 24;

/// Types of fixed size, which OpenEXR reads regardless of the size in the file: the following bytes
/// would be parsed as the next attribute there and skipped here.
struct TypeSize {
    std::string_view type;
    uint64_t bytes;
};

constexpr TypeSize kTypeSizes[] = {
    {"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
    {"m44d", 128},      {"m44f", 64},    {"rational", 8},
    {"tiledesc", 9},    {"timecode", 8}, {"v2d", 16},
    {"v2f", 8},         {"v2i", 8},      {"v3d", 24},
    {"v3f", 12},        {"v3i", 12},     {"deepImageState", 1},
};

class HeaderReader {
  public:
    HeaderReader(const std::string& path, uint64_t fileBytes, uint32_t maxSide)
        : mStream(path, std::ios::binary), mFileBytes(fileBytes), mMaxSide(maxSide) {}

    std::string check() {
        (void)readU32(); // the signature
        const uint32_t flags = readU32();
        if ((flags & kDeepBit) != 0)
            return "it is a deep EXR, not a flat picture";
        if ((flags & kManyPartsBit) != 0)
            return "it is an EXR of many parts, not a flat picture of one";
        for (std::string name = readName(); mStream && !name.empty(); name = readName()) {
            const std::string type = readName();
            const uint64_t bytes = readU32();
            const auto begin = uint64_t(mStream.tellg());
            if (!mStream || bytes > mFileBytes - begin)
                return "its attribute '" + makePrintable(name) + "' is longer than the file";
            if (!hasItsSize(type, begin, begin + bytes))
                return "its attribute '" + makePrintable(name) + "' is not of its type's size";
            mStream.seekg(std::streamoff(begin));
            if (const std::string why = checkAttribute(name, type); !why.empty())
                return why;
            mStream.seekg(std::streamoff(begin + bytes));
        }
        return mStream ? checkTiles() : "its header is cut off";
    }

  private:
    uint32_t readU32() {
        std::array<char, 4> bytes{};
        mStream.read(bytes.data(), std::streamsize(bytes.size()));
        uint32_t value = 0;
        for (size_t i = 0; i < bytes.size(); ++i)
            value |= uint32_t(uint8_t(bytes[i])) << (8 * i);
        return value;
    }

    /// Up to a NUL.
    std::string readName() {
        std::string name;
        char c = 0;
        while (mStream.get(c) && c != '\0' && name.size() < kMaxNameBytes)
            name.push_back(c);
        return name;
    }

    /// Whether OpenEXR, which reads a value of `type` from `begin` on, comes to its end at `end`.
    bool hasItsSize(const std::string& type, uint64_t begin, uint64_t end) {
        if (type == "chlist")
            return isChannelList(end);
        if (type == "stringvector")
            return isStringVector(begin, end);
        if (type == "preview") {
            const uint64_t width = readU32();
            const uint64_t height = readU32();
            return width * height == (end - begin - 8) / 4 && end - begin >= 8;
        }
        const auto* row =
            std::find_if(std::begin(kTypeSizes), std::end(kTypeSizes), [&](const TypeSize& known) {
                return known.type == type;
            });
        return row == std::end(kTypeSizes) || row->bytes == end - begin;
    }

    bool isChannelList(uint64_t end) {
        constexpr std::streamoff kChannelBytes = 16; // after the name
        while (mStream && !readName().empty())
            mStream.seekg(kChannelBytes, std::ios::cur);
        return mStream && uint64_t(mStream.tellg()) == end;
    }

    bool isStringVector(uint64_t begin, uint64_t end) {
        uint64_t place = begin;
        while (mStream && place < end) {
            mStream.seekg(std::streamoff(place));
            place += 4 + uint64_t(readU32());
        }
        return mStream && place == end;
    }

    static std::string makePrintable(std::string name) {
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?'
        );
        return name;
    }

    std::string checkAttribute(const std::string& name, const std::string& type) {
        if (name == "dataWindow" && type == "box2i") {
            const int64_t left = int32_t(readU32());
            const int64_t top = int32_t(readU32());
            const int64_t width = int32_t(readU32()) - left + 1;
            const int64_t height = int32_t(readU32()) - top + 1;
            if (width > mMaxSide || height > mMaxSide)
                return "it is too large (" + std::to_string(width) + "x" + std::to_string(height) +
                       ")";
            if (width < 1 || height < 1)
                return "it has no pixels";
            mWidth = uint64_t(width);
            mHeight = uint64_t(height);
        } else if (name == "tiles" && type == "tiledesc") {
            mTileWidth = readU32();
            mTileHeight = readU32();
        }
        return {};
    }

    std::string checkTiles() const {
        if (mTileWidth == 0 || mTileHeight == 0)
            return {};
        const uint64_t count = ((mWidth - 1) / mTileWidth + 1) * ((mHeight - 1) / mTileHeight + 1);
        if (mTileWidth * mTileHeight > kMaxTilePixels || count > mFileBytes / kOffsetBytes)
            return "it claims " + std::to_string(count) + " tiles of " +
                   std::to_string(mTileWidth) + "x" + std::to_string(mTileHeight) + " pixels";
        return {};
    }

    std::ifstream mStream;
    uint64_t mFileBytes;
    uint32_t mMaxSide;
    uint64_t mWidth = 1;
    uint64_t mHeight = 1;
    uint64_t mTileWidth = 0; ///< 0: lines
    uint64_t mTileHeight = 0;
};

} // namespace

std::string checkExrHeader(const std::string& path, uint64_t fileBytes, uint32_t maxSide) {
    return HeaderReader(path, fileBytes, maxSide).check();
}

} // namespace shutter::io
