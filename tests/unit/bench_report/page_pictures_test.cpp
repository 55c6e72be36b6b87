// SPDX-License-Identifier: MIT
#include "engine/io/image_file.h"
#include "game/bench/report/page_pictures.h"
#include "game/bench/report/page_template.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace shutter::bench {

namespace {

using nlohmann::json;

/// Noise: no two parts are alike.
image::Image makeNoise(uint32_t width, uint32_t height) {
    image::Image picture(width, height, 3);
    uint32_t state = width;
    for (float& value : picture.pixels) {
        state = state * 1664525u + 1013904223u;
        value = float(state >> 8) / float(1 << 24);
    }
    return picture;
}

/// A case of a truth and two measurements, with two crops, and a row at equal time that shows the
/// picture of another sample count.
class PagePicturesTest : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* name : {"truth", "a", "a.flip", "b", "b.flip", "rival"})
            ASSERT_TRUE(io::writeImage(path(name), makeNoise(kWidth, kHeight)));
        const auto measurement = [](const std::string& name) {
            return json{{"image", name + ".png"}, {"errorMap", name + ".flip.png"}};
        };
        mResults = {
            {"cases",
             {{{"name", "spin"},
               {"truth", {{"image", "truth.png"}}},
               {"crops",
                {{{"x", 8}, {"y", 4}, {"width", 32}, {"height", 24}, {"label", "first"}},
                 {{"x", 60}, {"y", 30}, {"width", 32}, {"height", 24}, {"label", "second"}}}},
               {"measurements", {measurement("a"), measurement("b")}}}}},
            {"equalTime",
             {{{"case", "spin"}, {"rows", {{{"image", "rival.png"}}, {{"image", "a.png"}}}}}}}};
    }

    [[nodiscard]] std::filesystem::path path(const std::string& name) const {
        return mFolder.path() / (name + ".png");
    }

    [[nodiscard]] json encode() const {
        auto encoded = encodePictures(mResults, mFolder.path());
        EXPECT_TRUE(encoded) << encoded.error().message;
        return encoded ? encoded.value() : json();
    }

    [[nodiscard]] std::string refusal() const {
        const auto encoded = encodePictures(mResults, mFolder.path());
        return encoded ? "(accepted)" : encoded.error().message;
    }

    static constexpr uint32_t kWidth = 128;
    static constexpr uint32_t kHeight = 96;
    test::TempFolder mFolder;
    json mResults;
};

bool contains(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_F(PagePicturesTest, WholePicturesAreJpegAndCropsAreThePixelsOfTheFile) {
    const json files = encode();
    EXPECT_EQ(files.at("whole").size(), 5u);
    for (const json& uri : files.at("whole"))
        EXPECT_TRUE(uri.get<std::string>().starts_with("data:image/jpeg;base64,"));
    EXPECT_FALSE(files.at("parts").contains("a.flip.png"));
    const json& parts = files.at("parts").at("a.png");
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts.at(1).at("x"), 60);
    EXPECT_EQ(parts.at(1).at("y"), 30);
    const auto stored = io::readImage(path("a"));
    ASSERT_TRUE(stored);
    image::Image expected(32, 24, 3);
    expected.channelNames = stored.value().channelNames;
    for (uint32_t y = 0; y < 24; ++y)
        for (uint32_t x = 0; x < 32; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                expected.at(x, y, c) = stored.value().at(60 + x, 30 + y, c);
    const auto bytes = io::encodeImage("a.png", expected);
    ASSERT_TRUE(bytes);
    EXPECT_EQ(parts.at(1).at("uri"), "data:image/png;base64," + encodeBase64(bytes.value()));
}

TEST_F(PagePicturesTest, OfARivalAtEqualTimeOnlyTheFirstCropIsThere) {
    const json files = encode();
    EXPECT_FALSE(files.at("whole").contains("rival.png"));
    const json& parts = files.at("parts").at("rival.png");
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts.at(0).at("x"), 8);
    EXPECT_EQ(parts.at(0).at("width"), 32);
    // A case without crops shows none of it.
    mResults["cases"][0].erase("crops");
    EXPECT_FALSE(encode().at("parts").contains("rival.png"));
}

TEST_F(PagePicturesTest, RefusesCropsThatAreNoneOrLeaveThePicture) {
    json& crop = mResults["cases"][0]["crops"][0];
    crop["x"] = kWidth - 31;
    EXPECT_TRUE(contains(refusal(), "leaves")) << refusal();
    EXPECT_TRUE(contains(refusal(), "which is 128x96")) << refusal();
    crop["x"] = 4294967295u;
    EXPECT_TRUE(contains(refusal(), "leaves")) << refusal();
    for (const json& bad : {json(-1), json("1"), json(1.5), json(4294967296u), json()}) {
        crop["x"] = bad;
        EXPECT_TRUE(contains(refusal(), "a crop of the case 'spin' has no 'x'")) << bad;
    }
    crop["x"] = 0;
    crop["height"] = 0;
    EXPECT_TRUE(contains(refusal(), "has no 'height' of 1 or more")) << refusal();
    mResults["cases"][0]["crops"][0] = "all";
    EXPECT_TRUE(contains(refusal(), "a crop of the case 'spin'")) << refusal();
}

} // namespace shutter::bench
