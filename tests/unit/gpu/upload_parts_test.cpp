// SPDX-License-Identifier: MIT
#include "engine/gpu/upload.h"

#include <gtest/gtest.h>

#include <vector>

namespace shutter::gpu {
namespace {

TEST(UploadParts, ASmallUploadIsOnePartAndAnEmptyOneNone) {
    EXPECT_EQ(splitUpload(0, 1), std::vector<UploadPart>{});
    EXPECT_EQ(splitUpload(7, 1), (std::vector<UploadPart>{{0, 7}}));
    EXPECT_EQ(splitUpload(kStagingBytes, 4), (std::vector<UploadPart>{{0, kStagingBytes}}));
}

TEST(UploadParts, LargeTransfersAreCutAndNoByteIsLost) {
    EXPECT_EQ(
        splitUpload(2 * kStagingBytes + 5, 1),
        (std::vector<UploadPart>{
            {0, kStagingBytes}, {kStagingBytes, kStagingBytes}, {2 * kStagingBytes, 5}})
    );
}

TEST(UploadParts, RowsStayWholeEvenOnesLargerThanAPart) {
    constexpr VkDeviceSize kRow = 3 * kStagingBytes / 4;
    EXPECT_EQ(splitUpload(2 * kRow, kRow), (std::vector<UploadPart>{{0, kRow}, {kRow, kRow}}));
    constexpr VkDeviceSize kLong = 2 * kStagingBytes;
    EXPECT_EQ(splitUpload(kLong, kLong), (std::vector<UploadPart>{{0, kLong}}));
}

} // namespace
} // namespace shutter::gpu
