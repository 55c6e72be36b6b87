// SPDX-License-Identifier: MIT
#include "engine/image/channels.h"

#include <gtest/gtest.h>

#include <array>

namespace shutter::image {

namespace {

Image makeNamed(const std::vector<std::string>& names) {
    Image picture(2, 1, uint32_t(names.size()));
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = float(i);
    picture.channelNames = names;
    return picture;
}

/// "2,1,0/3": red, green and blue, and alpha; "-" where there is no colour.
std::string colorOf(const Image& picture) {
    const auto color = findColor(picture);
    if (!color)
        return "-";
    std::string text;
    for (const uint32_t c : color->color)
        text += (text.empty() ? "" : ",") + std::to_string(c);
    return text + (color->alpha ? "/" + std::to_string(*color->alpha) : "");
}

} // namespace

TEST(Channels, AColourIsFoundByNamesInAnyOrder) {
    EXPECT_EQ(colorOf(makeNamed({"R", "G", "B"})), "0,1,2");
    EXPECT_EQ(colorOf(makeNamed({"A", "B", "G", "R", "Z"})), "3,2,1/0");
    EXPECT_EQ(colorOf(makeNamed({"Y"})), "0");
    EXPECT_EQ(colorOf(makeNamed({"Y", "A"})), "0/1");
    EXPECT_EQ(colorOf(makeNamed({"Z", "beauty.R", "beauty.G", "beauty.B", "beauty.A"})), "1,2,3/4");
    EXPECT_EQ(colorOf(makeNamed({"spec.R", "spec.G", "spec.B", "R", "G", "B", "spec.A"})), "3,4,5")
        << "the layer without a name comes first, and another's alpha is not its own";
}

TEST(Channels, WithoutNamesTheirNumberSaysWhatTheyAre) {
    EXPECT_EQ(colorOf(Image(1, 1, 1)), "0");
    EXPECT_EQ(colorOf(Image(1, 1, 2)), "0/1");
    EXPECT_EQ(colorOf(Image(1, 1, 3)), "0,1,2");
    EXPECT_EQ(colorOf(Image(1, 1, 4)), "0,1,2/3");
    EXPECT_EQ(colorOf(Image(1, 1, 5)), "-");
}

TEST(Channels, MotionDepthAndPartsOfAColourAreNone) {
    for (const auto& names : std::vector<std::vector<std::string>>{
             {"motion.x", "motion.y"},
             {"Z"},
             {"N.x", "N.y", "N.z"},
             {"R", "G"},
             {"R"},
             {"A"},
             {"P.X", "P.Y", "P.Z"},
             {"a.R", "b.G", "c.B"}})
        EXPECT_EQ(colorOf(makeNamed(names)), "-") << names.front();
}

TEST(Channels, ArePickedWithTheirNames) {
    const Image picked = pickChannels(makeNamed({"A", "B", "C"}), std::array<uint32_t, 2>{2, 0});
    EXPECT_EQ(picked.channelNames, (std::vector<std::string>{"C", "A"}));
    EXPECT_EQ(picked.pixels, (std::vector<float>{2, 0, 5, 3}));
    EXPECT_EQ(listChannels(makeNamed({"A", "B"}), std::array<uint32_t, 2>{0, 1}), "A, B");
    EXPECT_EQ(listChannels(Image(1, 1, 2), std::array<uint32_t, 1>{1}), "1");
}

} // namespace shutter::image
