// SPDX-License-Identifier: MIT
// What a driver is given of the cache of an earlier run.
#include "engine/gpu/pipeline_cache.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace shutter::gpu {
namespace {

namespace fs = std::filesystem;

constexpr PipelineCacheOwner kOwner{
    .vendorId = 0x10005, .deviceId = 7, .uuid = {1, 2, 3, 4, 5, 6, 7, 8, 9}};

std::vector<uint8_t> makeBlob(const PipelineCacheOwner& owner = kOwner) {
    VkPipelineCacheHeaderVersionOne header{};
    header.headerSize = sizeof(header);
    header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
    header.vendorID = owner.vendorId;
    header.deviceID = owner.deviceId;
    std::copy(owner.uuid.begin(), owner.uuid.end(), header.pipelineCacheUUID);
    std::vector<uint8_t> blob(sizeof(header) + 100, 42);
    std::memcpy(blob.data(), &header, sizeof(header));
    return blob;
}

TEST(PipelineCacheFile, PackedBytesAreUnpackedUnchanged) {
    const std::vector<uint8_t> blob = makeBlob();
    const std::vector<uint8_t> file = packPipelineCache(blob);
    const auto unpacked = unpackPipelineCache(file, kOwner);
    ASSERT_TRUE(unpacked && unpacked.value());
    EXPECT_TRUE(std::equal(blob.begin(), blob.end(), unpacked.value()->begin()));
    EXPECT_EQ(unpacked.value()->size(), blob.size());
}

TEST(PipelineCacheFile, AnyChangedByteKeepsTheCacheFromDrivers) {
    const std::vector<uint8_t> file = packPipelineCache(makeBlob());
    for (size_t i = 0; i < file.size(); ++i) {
        std::vector<uint8_t> damaged = file;
        damaged[i] ^= 0x10;
        const auto unpacked = unpackPipelineCache(damaged, kOwner);
        EXPECT_FALSE(unpacked && unpacked.value()) << i;
    }
    for (size_t bytes = 0; bytes < file.size(); ++bytes) {
        const auto unpacked = unpackPipelineCache(std::span(file).first(bytes), kOwner);
        EXPECT_FALSE(unpacked && unpacked.value()) << bytes;
    }
}

TEST(PipelineCacheFile, AnotherDriversCacheIsIgnoredWithoutAnError) {
    PipelineCacheOwner other = kOwner;
    other.uuid[3] = 0;
    const std::vector<uint8_t> file = packPipelineCache(makeBlob(other));
    const auto unpacked = unpackPipelineCache(file, kOwner);
    ASSERT_TRUE(unpacked);
    EXPECT_FALSE(unpacked.value());
    std::vector<uint8_t> unversioned = makeBlob();
    unversioned[5] = 0x30; // no value of the header's enum
    const std::vector<uint8_t> packed = packPipelineCache(unversioned);
    EXPECT_FALSE(unpackPipelineCache(packed, kOwner).value());
    const auto bare = unpackPipelineCache(makeBlob(), kOwner); // of a driver, without our header
    ASSERT_TRUE(bare);
    EXPECT_FALSE(bare.value());
}

TEST(PipelineCacheFile, TheCacheIsReadFromFilesUpToALimit) {
    const test::TempFolder folder;
    const std::vector<uint8_t> file = packPipelineCache(makeBlob());
    const fs::path path =
        folder.write("cache.bin", {reinterpret_cast<const char*>(file.data()), file.size()});
    EXPECT_EQ(readPipelineCache(path, kOwner), makeBlob());
    EXPECT_TRUE(readPipelineCache(folder.path(), kOwner).empty());
    EXPECT_TRUE(readPipelineCache(folder.path() / "missing", kOwner).empty());
    EXPECT_TRUE(readPipelineCache("", kOwner).empty());
    testing::internal::CaptureStderr();
    fs::resize_file(path, file.size() - 1);
    EXPECT_TRUE(readPipelineCache(path, kOwner).empty());
    EXPECT_NE(testing::internal::GetCapturedStderr().find("cache.bin"), std::string::npos);
    testing::internal::CaptureStderr();
    fs::resize_file(path, kMaxPipelineCacheBytes + 1); // sparse
    EXPECT_TRUE(readPipelineCache(path, kOwner).empty());
    EXPECT_NE(testing::internal::GetCapturedStderr().find("above the limit"), std::string::npos);
}

} // namespace
} // namespace shutter::gpu
