// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/mask_bits.glsl"

#include <gtest/gtest.h>

#include <random>

namespace shutter::shader {
namespace {

bool isMasked(uvec2 bits, uint x, uint y) {
    return hasBit(bits, x + 8 * y);
}

/// By the definition: masked, and no pixel of its quad before it is.
bool leads(uvec2 bits, uint x, uint y) {
    for (uint i = 0; i < x % 2 + y % 2 * 2; ++i)
        if (isMasked(bits, x - x % 2 + i % 2, y - y % 2 + i / 2))
            return false;
    return isMasked(bits, x, y);
}

/// Blocks of many densities.
template <class Check> void forBlocks(Check&& check) {
    std::mt19937 random(3);
    for (int i = 0; i < 300; ++i) {
        uvec2 bits(random(), random());
        for (int thin = 0; thin < i % 4; ++thin)
            bits &= uvec2(random(), random());
        check(i == 0 ? uvec2(0u) : i == 1 ? uvec2(~0u) : bits);
    }
}

TEST(MaskBits, TheFirstMaskedPixelOfAQuadLeadsIt) {
    forBlocks([](uvec2 bits) {
        const uvec2 listed = listedBits(bits, true);
        for (uint y = 0; y < 8; ++y)
            for (uint x = 0; x < 8; ++x)
                ASSERT_EQ(isMasked(listed, x, y), leads(bits, x, y)) << x << ", " << y;
    });
}

TEST(MaskBits, WithoutQuadsAllMaskedPixelsAreListed) {
    forBlocks([](uvec2 bits) { ASSERT_EQ(listedBits(bits, false), bits); });
}

TEST(MaskBits, ThreadsTakeThePlacesInTurn) {
    forBlocks([](uvec2 bits) {
        uint place = 0;
        for (uint thread = 0; thread < 64; ++thread) {
            ASSERT_EQ(countBitsBefore(bits, thread), place) << thread;
            place += hasBit(bits, thread) ? 1 : 0;
        }
        ASSERT_EQ(countBits(bits), place);
    });
}

TEST(MaskBits, RowsBeginAtTheirFirstEntry) {
    EXPECT_EQ(countRows(0, 4), 0u);
    EXPECT_EQ(countRows(1, 4), 1u);
    EXPECT_EQ(countRows(4, 4), 1u);
    EXPECT_EQ(countRows(5, 4), 2u);
}

} // namespace
} // namespace shutter::shader
