// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "game/bench/report/report_page.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        mFolder = fs::path(::testing::TempDir()) / (std::string("report_page_") + info->name());
        fs::remove_all(mFolder);
        fs::create_directories(mFolder / "images");
        ASSERT_TRUE(io::writeImage(mFolder / "images/truth.png", image::Image(8, 8, 3)));
    }

    void TearDown() override {
        if (!mFolder.empty())
            fs::remove_all(mFolder);
    }

    void write(const char* name, std::string_view text) const {
        ASSERT_TRUE(io::writeFileText(mFolder / name, text).ok());
    }

    std::string readPage() const {
        const auto bytes = io::readFileBytes(mFolder / "index.html", 1U << 26U);
        return bytes ? std::string(bytes.value().begin(), bytes.value().end()) : "";
    }

    /// The sentence of a refusal, after which no page must be there.
    std::string refusal(const json& results) const {
        const core::Status status = writeReportPage(results, mFolder);
        EXPECT_FALSE(fs::exists(mFolder / "index.html"));
        return status ? "(accepted)" : status.error().message;
    }

    fs::path mFolder;
};

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

} // namespace

TEST_F(ReportPage, HoldsTheResultsThePicturesAndTheLibrary) {
    json results = makeResults();
    results["suite"] = "unmistakable name";
    ASSERT_TRUE(writeReportPage(results, mFolder).ok());
    const std::string page = readPage();
    EXPECT_TRUE(contains(page, "unmistakable name"));
    EXPECT_TRUE(contains(page, "data:image/jpeg;base64,"));
    EXPECT_TRUE(contains(page, "Chart.js v3"));
    EXPECT_FALSE(contains(page, "{{results}}"));
}

TEST_F(ReportPage, NamesAMissingPicture) {
    json results = makeResults();
    results["cases"][0]["measurements"] = {{{"errorMap", "images/absent.png"}}};
    const std::string sentence = refusal(results);
    EXPECT_TRUE(contains(sentence, "images/absent.png': no such file")) << sentence;
}

TEST_F(ReportPage, RefusesAPictureThatIsNoPng) {
    write("images/truth.png", "GIF89a");
    EXPECT_TRUE(contains(refusal(makeResults()), "truth.png' is not a PNG"));
    write("images/truth.png", "");
    EXPECT_TRUE(contains(refusal(makeResults()), "truth.png' is not a PNG"));
}

TEST_F(ReportPage, TakesNoPictureFromOutsideItsFolder) {
    for (const char* path : {"../secret.png", "/etc/hostname", "images/../../secret.png"}) {
        json results = makeResults();
        results["cases"][0]["truth"]["image"] = path;
        EXPECT_TRUE(contains(refusal(results), path)) << refusal(results);
    }
}

TEST_F(ReportPage, RefusesOtherSchemasAndVersions) {
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

TEST_F(ReportPage, KeepsTheOldPageWhenTheNewOneFails) {
    ASSERT_TRUE(writeReportPage(makeResults(), mFolder).ok());
    const std::string before = readPage();
    fs::remove(mFolder / "images/truth.png");
    ASSERT_FALSE(writeReportPage(makeResults(), mFolder).ok());
    EXPECT_EQ(readPage(), before);
}

TEST_F(ReportPage, IsMadeAgainFromTheResultsFile) {
    write("results.json", makeResults().dump());
    ASSERT_TRUE(remakeReportPage(mFolder).ok());
    const std::string again = readPage();
    ASSERT_TRUE(writeReportPage(makeResults(), mFolder).ok());
    EXPECT_EQ(readPage(), again);
}

TEST_F(ReportPage, SaysThatTheResultsFileIsMissingOrBroken) {
    const core::Status missing = remakeReportPage(mFolder);
    ASSERT_FALSE(missing.ok());
    EXPECT_TRUE(contains(missing.error().message, "results.json': no such file"));
    write("results.json", "{\"schema\": ");
    const core::Status broken = remakeReportPage(mFolder);
    ASSERT_FALSE(broken.ok());
    EXPECT_TRUE(contains(broken.error().message, "results.json' is not valid JSON"));
}

TEST_F(ReportPage, RefusesAResultsFileThatIsNestedWithoutEnd) {
    // So deep that what walks it, and calls itself for each level, would run out of stack.
    constexpr size_t kLevels = 1'000'000;
    const std::string nested = std::string(kLevels, '[') + std::string(kLevels, ']');
    std::string text = makeResults().dump();
    text.insert(1, "\"extra\": " + nested + ", ");
    write("results.json", text);
    const core::Status status = remakeReportPage(mFolder);
    ASSERT_FALSE(status.ok());
    EXPECT_TRUE(contains(status.error().message, "deeper than 32 levels"));
    EXPECT_FALSE(fs::exists(mFolder / "index.html"));
}

} // namespace shutter::bench
