// SPDX-License-Identifier: MIT
// The page of a report, its template, its pictures and their encoding.
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/io/uri.h"
#include "game/bench/report/page_parts.h"
#include "game/bench/report/report_page.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::bench {
namespace {

using nlohmann::json;

namespace fs = std::filesystem;

/// The least that a page is made of, with one picture.
json makeResults() {
    return {
        {"schema", "shutter-bench"},
        {"version", 2},
        {"metrics", json::array()},
        {"methods", json::array()},
        {"cases", {{{"truth", {{"image", "images/truth.png"}}}}}}};
}

class ReportPage : public ::testing::Test {
  protected:
    void SetUp() override {
        if (const core::Status possible = checkReportPageCanBeMade(); !possible)
            GTEST_SKIP() << possible.error().message;
        fs::create_directories(mFolder / "images");
        ASSERT_TRUE(io::writeImage(mFolder / "images/truth.png", image::Image(8, 8, 3)));
    }

    void write(const char* name, std::string_view text) const {
        ASSERT_TRUE(io::writeFileText(mFolder / name, text).ok());
    }

    std::string readPage() const {
        const auto bytes = test::valueOf(io::readFileBytes(mFolder / "index.html", 1U << 26U));
        return {bytes.begin(), bytes.end()};
    }

    /// The sentence of a refusal, after which no page must be there.
    std::string refusal(const json& results) const {
        const core::Status status = writeReportPage(results, mFolder);
        EXPECT_FALSE(fs::exists(mFolder / "index.html"));
        return test::errorOf(status);
    }

    const test::TempFolder mTemporary;
    const fs::path mFolder = mTemporary.path();
};

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

TEST_F(ReportPage, ThePageContainsTheResultsThePicturesAndTheLibrary) {
    json results = makeResults();
    results["suite"] = "unmistakable name";
    ASSERT_TRUE(writeReportPage(results, mFolder).ok());
    const std::string page = readPage();
    EXPECT_TRUE(contains(page, "unmistakable name"));
    EXPECT_TRUE(contains(page, "data:image/jpeg;base64,"));
    EXPECT_TRUE(contains(page, "Chart.js v3"));
    EXPECT_FALSE(contains(page, "{{results}}"));
}

TEST_F(ReportPage, PicturesThatAreMissingOutsideTheFolderOrNoPngAreRefused) {
    for (const char* path :
         {"images/absent.png", "../secret.png", "/etc/hostname", "images/../../secret.png"}) {
        json results = makeResults();
        results["cases"][0]["truth"]["image"] = path;
        EXPECT_TRUE(contains(refusal(results), path)) << refusal(results);
    }
    json results = makeResults();
    results["cases"][0]["measurements"] = {{{"errorMap", "images/absent.png"}}};
    EXPECT_TRUE(contains(refusal(results), "images/absent.png': no such file"));
    for (const char* other : {"GIF89a", ""}) {
        write("images/truth.png", other);
        EXPECT_TRUE(contains(refusal(makeResults()), "truth.png' is not a PNG"));
    }
}

TEST_F(ReportPage, OtherSchemasAndVersionsAreRefused) {
    json results = makeResults();
    results["schema"] = "another";
    EXPECT_TRUE(contains(refusal(results), "schema 'shutter-bench'"));
    EXPECT_TRUE(contains(refusal(json::array()), "schema 'shutter-bench'"));
    results = makeResults();
    results["version"] = 1;
    EXPECT_TRUE(contains(refusal(results), "version 1"));
    results.erase("version");
    EXPECT_TRUE(contains(refusal(results), "version null"));
    results = makeResults();
    results["methods"] = "none";
    EXPECT_TRUE(contains(refusal(results), "'methods'"));
}

TEST_F(ReportPage, TheReportIsRebuiltFromTheResultsFileAndTheOldOneRemainsIfThatFails) {
    ASSERT_TRUE(writeReportPage(makeResults(), mFolder).ok());
    const std::string before = readPage();
    write("results.json", makeResults().dump());
    ASSERT_TRUE(remakeReportPage(mFolder).ok());
    EXPECT_EQ(readPage(), before);
    fs::remove(mFolder / "images/truth.png");
    ASSERT_FALSE(writeReportPage(makeResults(), mFolder).ok());
    EXPECT_EQ(readPage(), before);
}

TEST_F(ReportPage, AMissingBrokenOrEndlesslyNestedResultsFileIsRefused) {
    test::expectRefused(remakeReportPage(mFolder), "results.json': no such file");
    write("results.json", "{\"schema\": ");
    test::expectRefused(remakeReportPage(mFolder), "results.json' is not valid JSON");
    // So deep that what walks it, and calls itself for each level, would run out of stack.
    constexpr size_t kLevels = 1'000'000;
    const std::string nested = std::string(kLevels, '[') + std::string(kLevels, ']');
    std::string text = makeResults().dump();
    text.insert(1, "\"extra\": " + nested + ", ");
    write("results.json", text);
    test::expectRefused(remakeReportPage(mFolder), "deeper than 32 levels");
    EXPECT_FALSE(fs::exists(mFolder / "index.html"));
}

TEST(FillPage, EachValueIsInsertedInEachOfItsPlacesOnceAndBothMustBeThere) {
    const auto filled = test::valueOf(fillPage("{ } <{{a}}>{{b}}{{a}}", {{"a", "one"}, {"b", ""}}));
    EXPECT_EQ(filled, "{ } <one>one");
    const auto nested =
        test::valueOf(fillPage("{{a}} {{b}}", {{"a", "{{b}} }} {{"}, {"b", "two"}}));
    EXPECT_EQ(nested, "{{b}} }} {{ two");
    test::expectRefused(fillPage("{{a}}{{missing}}", {{"a", "x"}}), "'missing'");
    test::expectRefused(fillPage("{{a}}", {{"a", "x"}, {"extra", "y"}}), "'extra'");
    EXPECT_FALSE(fillPage("{{a}} {{a", {{"a", "x"}}).ok()) << "it does not end";
}

TEST(EscapeForScript, EscapedTextEndsNeitherTheElementNorTheLine) {
    const nlohmann::json value = {
        {"a", "</script><!-- </SCRIPT \xE2\x80\xA8 and \xE2\x80\xA9 <b>"},
        {"</key>", "\xE2\x80\x9C quoted \xE2\x80\x9D \xE2\x80"}}; // cut short: not UTF-8
    const std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const std::string escaped = escapeForScript(text);
    EXPECT_EQ(escaped.find('<'), std::string::npos);
    EXPECT_EQ(escaped.find("\xE2\x80\xA8"), std::string::npos);
    EXPECT_EQ(escaped.find("\xE2\x80\xA9"), std::string::npos);
    EXPECT_NE(escaped.find("\xE2\x80\x9C"), std::string::npos) << "other characters stay";
    EXPECT_EQ(nlohmann::json::parse(escaped), nlohmann::json::parse(text));
    EXPECT_EQ(escapeForScript(""), "");
    EXPECT_EQ(escapeForScript("\xE2\x80"), "\xE2\x80");
    EXPECT_EQ(escapeForScript("\xE2\x80\xA8"), "\\u2028");
    EXPECT_EQ(escapeForScript("\xE2\x80\xA9"), "\\u2029");
}

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
        return test::valueOf(encodePictures(mResults, mFolder.path()));
    }

    [[nodiscard]] std::string refusal() const {
        return test::errorOf(encodePictures(mResults, mFolder.path()));
    }

    static constexpr uint32_t kWidth = 128;
    static constexpr uint32_t kHeight = 96;
    test::TempFolder mFolder;
    json mResults;
};

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
    const image::Image stored = test::valueOf(io::readImage(path("a")));
    image::Image expected(32, 24, 3);
    expected.channelNames = stored.channelNames;
    for (uint32_t y = 0; y < 24; ++y)
        for (uint32_t x = 0; x < 32; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                expected.at(x, y, c) = stored.at(60 + x, 30 + y, c);
    const auto bytes = test::valueOf(io::encodeImage("a.png", expected));
    EXPECT_EQ(parts.at(1).at("uri"), "data:image/png;base64," + encodeBase64(bytes));
}

TEST_F(PagePicturesTest, ARivalAtEqualTimeHasOnlyTheFirstCrop) {
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

TEST_F(PagePicturesTest, EmptyCropsAndCropsOutsideThePictureAreRefused) {
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

std::string encodeText(std::string_view text) {
    return encodeBase64({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

TEST(EncodeBase64, EncodingAgreesWithTheVectorsOfTheStandardAndIsDecodedUnchanged) {
    // RFC 4648, section 10.
    const std::string text = "foobar";
    const char* kEncoded[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
    for (size_t i = 0; i <= text.size(); ++i)
        EXPECT_EQ(encodeText(text.substr(0, i)), kEncoded[i]);
    std::vector<uint8_t> bytes(256);
    std::iota(bytes.begin(), bytes.end(), uint8_t(0));
    const std::string uri = "data:image/png;base64," + encodeBase64(bytes);
    EXPECT_EQ(test::valueOf(io::decodeDataUri(uri)), bytes);
}

} // namespace
} // namespace shutter::bench
