// SPDX-License-Identifier: MIT
#include "engine/io/exr_header.h"

#include <algorithm>
#include <array>
#include <fstream>

namespace shutter::io {

namespace {

constexpr uint32_t kDeepBit = 0x800;
constexpr uint32_t kManyPartsBit = 0x1000;
constexpr size_t kMaxNameBytes = 255;
/// Of a tile's entry in the table of offsets, which stands after the header.
constexpr uint64_t kOffsetBytes = 8;
constexpr uint64_t kMaxTilePixels = uint64_t(1) << 24;

class HeaderReader {
  public:
    HeaderReader(const std::string& path, uint64_t fileBytes, uint32_t maxSide)
        : mStream(path, std::ios::binary), mFileBytes(fileBytes), mMaxSide(maxSide) {}

    std::string check() {
        (void)readU32(); // the signature
        if ((readU32() & (kDeepBit | kManyPartsBit)) != 0)
            return "it is not a flat picture";
        for (std::string name = readName(); mStream && !name.empty(); name = readName()) {
            const std::string type = readName();
            const uint64_t bytes = readU32();
            const auto begin = uint64_t(mStream.tellg());
            if (!mStream || bytes > mFileBytes - begin)
                return "its attribute '" + makePrintable(name) + "' is longer than the file";
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
