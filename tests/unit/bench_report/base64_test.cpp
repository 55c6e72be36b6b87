// SPDX-License-Identifier: MIT
#include "engine/io/uri.h"
#include "game/bench/report/page_template.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string_view>
#include <vector>

namespace shutter::bench {

namespace {

std::string encodeText(std::string_view text) {
    return encodeBase64({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

} // namespace

// RFC 4648, section 10.
TEST(EncodeBase64, AgreesWithTheVectorsOfTheStandard) {
    EXPECT_EQ(encodeText(""), "");
    EXPECT_EQ(encodeText("f"), "Zg==");
    EXPECT_EQ(encodeText("fo"), "Zm8=");
    EXPECT_EQ(encodeText("foo"), "Zm9v");
    EXPECT_EQ(encodeText("foob"), "Zm9vYg==");
    EXPECT_EQ(encodeText("fooba"), "Zm9vYmE=");
    EXPECT_EQ(encodeText("foobar"), "Zm9vYmFy");
}

TEST(EncodeBase64, ComesBackThroughTheDecoder) {
    std::vector<uint8_t> bytes(256);
    std::iota(bytes.begin(), bytes.end(), uint8_t(0));
    const auto decoded = io::decodeDataUri("data:image/png;base64," + encodeBase64(bytes));
    ASSERT_TRUE(decoded.ok());
    EXPECT_EQ(decoded.value(), bytes);
}

} // namespace shutter::bench
