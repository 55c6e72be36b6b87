// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace shutter::io {

TEST(ContentHash, IsThirtyTwoDigitsAndChangesWithEachByte) {
    std::set<std::string> seen;
    const std::string base(200, 'a');
    for (size_t i = 0; i <= base.size(); ++i) {
        std::string changed = base;
        if (i < base.size())
            changed[i] = 'b';
        const std::string hash = computeContentHash(changed);
        EXPECT_EQ(hash.size(), 32u);
        EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
        seen.insert(hash);
    }
    EXPECT_EQ(seen.size(), base.size() + 1);
    EXPECT_NE(computeContentHash(""), computeContentHash(std::string(1, '\0')));
}

TEST(ContentHash, OfAFileIsThatOfItsBytes) {
    const test::TempFolder folder;
    const std::string bytes("x\0y", 3);
    const auto hash = computeFileHash(folder.write("a.bin", bytes));
    ASSERT_TRUE(hash.ok());
    EXPECT_EQ(hash.value(), computeContentHash(bytes));
}

TEST(ContentHash, AMissingFileIsNamed) {
    const auto hash = computeFileHash("no/such/file");
    ASSERT_FALSE(hash.ok());
    EXPECT_NE(hash.error().message.find("no/such/file"), std::string::npos);
}

} // namespace shutter::io
