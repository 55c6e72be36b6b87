// SPDX-License-Identifier: MIT
#include "engine/gpu/pipeline_cache.h"

#include "engine/core/log.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <system_error>

namespace shutter::gpu {

namespace {

namespace fs = std::filesystem;

constexpr std::array<uint8_t, 8> kFileMagic = {'S', 'h', 'u', 't', 'P', 'C', '0', '1'};

/// Before the blob.
struct FileHeader {
    std::array<uint8_t, 8> magic = kFileMagic;
    uint64_t blobBytes = 0;
    uint64_t checksum = 0;
};

static_assert(sizeof(FileHeader) == 24);

/// FNV-1a, 64 bits: finds damage, not malice.
uint64_t computeChecksum(std::span<const uint8_t> bytes) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (const uint8_t byte : bytes)
        hash = (hash ^ byte) * 0x100000001b3u;
    return hash;
}

bool isOwnedBy(std::span<const uint8_t> blob, const PipelineCacheOwner& owner) {
    /// VkPipelineCacheHeaderVersionOne, whose version is an enum and so must not hold just any
    /// value.
    struct BlobHeader {
        uint32_t headerSize = 0;
        uint32_t headerVersion = 0;
        uint32_t vendorId = 0;
        uint32_t deviceId = 0;
        std::array<uint8_t, VK_UUID_SIZE> uuid{};
    } header;

    static_assert(sizeof(header) == sizeof(VkPipelineCacheHeaderVersionOne));
    if (blob.size() < sizeof(header))
        return false;
    std::memcpy(&header, blob.data(), sizeof(header));
    return header.headerSize >= sizeof(header) &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorId == owner.vendorId && header.deviceId == owner.deviceId &&
           header.uuid == owner.uuid;
}

/// Nothing where the file cannot be read.
std::vector<uint8_t> readFile(const fs::path& file) {
    std::error_code failure;
    const uint64_t bytes = fs::is_regular_file(file, failure) ? fs::file_size(file, failure) : 0;
    if (failure || bytes == 0)
        return {};
    if (bytes > kMaxPipelineCacheBytes) {
        core::logWarning(
            "'{}' is not used: it has {} bytes, above the limit of {}",
            file.string(),
            bytes,
            kMaxPipelineCacheBytes
        );
        return {};
    }
    std::vector<uint8_t> contents(bytes);
    std::ifstream stream(file, std::ios::binary);
    stream.read(reinterpret_cast<char*>(contents.data()), std::streamsize(bytes));
    contents.resize(size_t(std::max<std::streamsize>(stream.gcount(), 0)));
    return contents;
}

} // namespace

std::vector<uint8_t> packPipelineCache(std::span<const uint8_t> blob) {
    const FileHeader header{.blobBytes = blob.size(), .checksum = computeChecksum(blob)};
    std::vector<uint8_t> file(sizeof(header) + blob.size());
    std::memcpy(file.data(), &header, sizeof(header));
    std::copy(blob.begin(), blob.end(), file.begin() + sizeof(header));
    return file;
}

core::Result<std::optional<std::span<const uint8_t>>>
unpackPipelineCache(std::span<const uint8_t> file, const PipelineCacheOwner& owner) {
    using Blob = std::optional<std::span<const uint8_t>>;
    FileHeader header;
    if (file.size() < sizeof(header) ||
        !std::equal(kFileMagic.begin(), kFileMagic.end(), file.begin()))
        return Blob();
    std::memcpy(&header, file.data(), sizeof(header));
    const std::span<const uint8_t> blob = file.subspan(sizeof(header));
    if (header.blobBytes != blob.size())
        return core::makeError("it should hold {} bytes, not {}", header.blobBytes, blob.size());
    if (header.checksum != computeChecksum(blob))
        return core::makeError("its checksum is wrong");
    return isOwnedBy(blob, owner) ? Blob(blob) : Blob();
}

std::vector<uint8_t> readPipelineCache(const fs::path& file, const PipelineCacheOwner& owner) {
    if (file.empty())
        return {};
    const std::vector<uint8_t> contents = readFile(file);
    const auto blob = unpackPipelineCache(contents, owner);
    if (!blob) {
        core::logWarning("'{}' is not used: {}", file.string(), blob.error().message);
        return {};
    }
    if (!blob.value())
        return {};
    return {blob.value()->begin(), blob.value()->end()};
}

} // namespace shutter::gpu
