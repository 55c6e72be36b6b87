// SPDX-License-Identifier: MIT
#include "engine/io/image_file.h"
#include "game/bench/report/page_pictures.h"
#include "game/bench/report/page_template.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace shutter::bench {

namespace {

using nlohmann::json;

constexpr size_t kNoLimit = size_t(1) << 40;

/// Noise, which no compression makes much smaller.
image::Image makeNoise(uint32_t width, uint32_t height, uint32_t channels) {
    image::Image picture(width, height, channels);
    uint32_t state = width;
    for (float& value : picture.pixels) {
        state = state * 1664525u + 1013904223u;
        value = float(state >> 8) / float(1 << 24);
    }
    return picture;
}

image::Image makeLinear(uint32_t width, uint32_t height) {
    image::Image picture = makeNoise(width, height, 4);
    picture.channelNames = {"R", "G", "B", "flip"};
    return picture;
}

/// A case of a truth and two measurements, with two crops, and a row at equal time that shows the
/// picture of another sample count.
class PagePicturesTest : public testing::Test {
  protected:
    void SetUp() override {
        for (const char* name : {"truth", "a", "a.flip", "b", "b.flip", "rival"})
            ASSERT_TRUE(io::writeImage(path(name, ".png"), makeNoise(kWidth, kHeight, 3)));
        for (const char* name : {"truth", "a", "b"})
            ASSERT_TRUE(io::writeImage(
                path(name, ".exr"), makeLinear(kWidth, kHeight), io::SampleType::Half
            ));
        const auto measurement = [](const std::string& name) {
            return json{
                {"image", name + ".png"},
                {"errorMap", name + ".flip.png"},
                {"linear", name + ".exr"}};
        };
        mResults = {
            {"cases",
             {{{"name", "spin"},
               {"truth", {{"image", "truth.png"}, {"linear", "truth.exr"}}},
               {"crops",
                {{{"x", 8}, {"y", 4}, {"width", 32}, {"height", 24}, {"label", "first"}},
                 {{"x", 60}, {"y", 30}, {"width", 32}, {"height", 24}, {"label", "second"}},
                 {{"x", 90}, {"y", 60}, {"width", 30}, {"height", 20}, {"label", "third"}}}},
               {"measurements", {measurement("a"), measurement("b")}}}}},
            {"equalTime",
             {{{"case", "spin"}, {"rows", {{{"image", "rival.png"}}, {{"image", "a.png"}}}}}}}};
    }

    [[nodiscard]] std::filesystem::path path(const std::string& name, const char* ending) const {
        return mFolder.path() / (name + ending);
    }

    [[nodiscard]] PagePictures encode(size_t budgetBytes) const {
        auto encoded = encodePictures(mResults, mFolder.path(), budgetBytes);
        EXPECT_TRUE(encoded) << encoded.error().message;
        return encoded ? encoded.value() : PagePictures();
    }

    /// The budget that a detail just keeps within: the bytes of what is encoded with `above` less.
    [[nodiscard]] PagePictures encodeBelow(const PagePictures& above) const {
        return encode(above.bytes - 1);
    }

    [[nodiscard]] std::string refusal() const {
        const auto encoded = encodePictures(mResults, mFolder.path(), kNoLimit);
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

TEST_F(PagePicturesTest, WhereThereIsRoomAllIsExact) {
    const PagePictures all = encode(kNoLimit);
    EXPECT_EQ(all.files.at("whole").size(), 5u);
    for (const json& uri : all.files.at("whole"))
        EXPECT_TRUE(uri.get<std::string>().starts_with("data:image/png;base64,"));
    for (const char* name : {"truth.exr", "a.exr", "b.exr"}) {
        const json& parts = all.files.at("parts").at(name);
        ASSERT_EQ(parts.size(), 1u);
        EXPECT_EQ(parts.at(0).at("width"), kWidth);
        EXPECT_EQ(parts.at(0).at("height"), kHeight);
    }
    EXPECT_TRUE(all.files.at("detail").at("jpegQuality").is_null());
    EXPECT_TRUE(all.files.at("detail").at("linearWhole").get<bool>());
}

TEST_F(PagePicturesTest, OfARivalAtEqualTimeOnlyTheFirstCropIsThere) {
    const PagePictures all = encode(kNoLimit);
    EXPECT_FALSE(all.files.at("whole").contains("rival.png"));
    const json& parts = all.files.at("parts").at("rival.png");
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts.at(0).at("x"), 8);
    EXPECT_EQ(parts.at(0).at("width"), 32);
    EXPECT_TRUE(parts.at(0).at("uri").get<std::string>().starts_with("data:image/png;base64,"));
    // A case without crops shows none of it.
    mResults["cases"][0].erase("crops");
    EXPECT_FALSE(encode(kNoLimit).files.at("parts").contains("rival.png"));
}

TEST_F(PagePicturesTest, EveryDetailIsSmallerThanTheOneBefore) {
    PagePictures before = encode(kNoLimit);
    for (const PictureDetail& detail : listPictureDetails().subspan(1)) {
        const PagePictures next = encodeBelow(before);
        EXPECT_LT(next.bytes, before.bytes);
        EXPECT_EQ(next.detail.jpegQuality, detail.jpegQuality);
        EXPECT_EQ(next.detail.isLinearWhole, detail.isLinearWhole);
        EXPECT_EQ(next.detail.linearCropCount, detail.linearCropCount);
        EXPECT_LE(next.bytes, next.files.dump().size());
        before = next;
    }
    // Below the last one there is nothing.
    EXPECT_EQ(encodeBelow(before).bytes, before.bytes);
}

TEST_F(PagePicturesTest, CropsAreTheFloatsOfTheFile) {
    const PagePictures whole = encode(kNoLimit);
    const PagePictures jpeg = encodeBelow(whole);
    const PagePictures crops = encodeBelow(jpeg);
    ASSERT_FALSE(crops.detail.isLinearWhole);
    const json& parts = crops.files.at("parts").at("a.exr");
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts.at(1).at("x"), 60);
    EXPECT_EQ(parts.at(1).at("y"), 30);
    const auto stored = io::readImage(path("a", ".exr"));
    ASSERT_TRUE(stored);
    image::Image expected(32, 24, 4);
    expected.channelNames = stored.value().channelNames;
    for (uint32_t y = 0; y < 24; ++y)
        for (uint32_t x = 0; x < 32; ++x) {
            for (uint32_t c = 0; c < 3; ++c)
                expected.at(x, y, c) = stored.value().at(60 + x, 30 + y, c);
            // Errors are as fine as their colours.
            const float error = stored.value().at(60 + x, 30 + y, 3);
            expected.at(x, y, 3) = std::round(error * 256.0f) / 256.0f;
        }
    const auto bytes = io::encodeImage("a.exr", expected, io::SampleType::Half);
    ASSERT_TRUE(bytes);
    EXPECT_EQ(parts.at(1).at("exr"), encodeBase64(bytes.value()));
}

TEST_F(PagePicturesTest, ErrorsHaveTheColoursOfTheirMaps) {
    const std::string magma = encode(kNoLimit).files.at("magma");
    EXPECT_EQ(magma.size(), 256u * 3 / 3 * 4);
    EXPECT_TRUE(magma.starts_with(encodeBase64(std::vector<uint8_t>{0, 0, 4}))) << magma;
    EXPECT_TRUE(magma.ends_with(encodeBase64(std::vector<uint8_t>{0xFC, 0xFD, 0xBF}))) << magma;
}

TEST_F(PagePicturesTest, RefusesALinearPictureThatIsMissingOrHasNoColours) {
    mResults["cases"][0]["truth"]["linear"] = "absent.exr";
    EXPECT_TRUE(contains(refusal(), "absent.exr': no such file")) << refusal();
    mResults["cases"][0]["truth"]["linear"] = "../truth.exr";
    EXPECT_TRUE(contains(refusal(), "../truth.exr")) << refusal();
    image::Image motion(4, 4, 3);
    motion.channelNames = {"R", "G", "motion.x"};
    ASSERT_TRUE(io::writeImage(path("motion", ".exr"), motion));
    mResults["cases"][0]["truth"]["linear"] = "motion.exr";
    EXPECT_TRUE(contains(refusal(), "motion.exr' has no channel B")) << refusal();
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
