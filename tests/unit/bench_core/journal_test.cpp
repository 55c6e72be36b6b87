// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "game/bench/journal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace shutter::bench {

namespace {

class JournalFile : public testing::Test {
  protected:
    JournalFile() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        mReport =
            std::filesystem::path(testing::TempDir()) / (std::string("report_") + test->name());
        std::filesystem::remove_all(mReport);
        mFile = mReport / "journal" / "case.json";
        std::filesystem::create_directories(mFile.parent_path());
    }

    ~JournalFile() override { std::filesystem::remove_all(mReport); }

    std::filesystem::path mReport;
    std::filesystem::path mFile;
};

} // namespace

TEST_F(JournalFile, WhatWasMeasuredIsThereAgain) {
    {
        Journal journal(mFile, "a");
        ASSERT_TRUE(journal.addSample("hybrid/15", {{{"gather", 1.5}}, 3.0}).ok());
        ASSERT_TRUE(journal.addSample("hybrid/15", {{{"gather", 2.5}}, 4.0}).ok());
        PictureFacts facts;
        facts.metrics = {{"psnr", std::numeric_limits<double>::infinity()}, {"flip", 0.25}};
        facts.image = "images/x.png";
        facts.linear = "images/x.exr";
        facts.counters = {{"rays traced", 7}};
        ASSERT_TRUE(journal.setPicture("hybrid/15", facts).ok());
        ASSERT_TRUE(journal.skip("truth/256", "too long").ok());
    }
    const Journal again(mFile, "a");
    const Record& record = again.find("hybrid/15");
    ASSERT_EQ(record.samples.size(), 2u);
    EXPECT_EQ(record.samples[1].passes[0].name, "gather");
    EXPECT_EQ(record.samples[1].passes[0].milliseconds, 2.5);
    EXPECT_EQ(record.samples[1].wallMilliseconds, 4.0);
    ASSERT_TRUE(record.hasPicture);
    EXPECT_TRUE(std::isinf(record.picture.metrics.at("psnr")));
    EXPECT_EQ(record.picture.metrics.at("flip"), 0.25);
    EXPECT_EQ(record.picture.linear, "images/x.exr");
    EXPECT_EQ(record.picture.counters.at("rays traced"), 7u);
    EXPECT_EQ(again.find("truth/256").skipped, "too long");
    EXPECT_FALSE(again.find("truth/256").hasPicture);
    EXPECT_TRUE(again.find("never").samples.empty());
}

TEST_F(JournalFile, WhatIsMeasuredAfterAllIsNoLongerSkipped) {
    Journal journal(mFile, "a");
    ASSERT_TRUE(journal.skip("truth/256", "too long").ok());
    ASSERT_TRUE(journal.addSample("truth/256", {}).ok());
    EXPECT_TRUE(Journal(mFile, "a").find("truth/256").skipped.empty());
}

TEST_F(JournalFile, AnotherFingerprintStartsAnew) {
    ASSERT_TRUE(Journal(mFile, "a").addSample("x/1", {}).ok());
    EXPECT_TRUE(Journal(mFile, "b").records().empty());
    EXPECT_EQ(Journal(mFile, "a").records().size(), 1u);
}

TEST_F(JournalFile, WhatIsNoJournalStartsAnew) {
    for (const char* text : {"", "{", "[]", "{\"fingerprint\":\"a\",\"records\":{\"x\":{}}}"}) {
        ASSERT_TRUE(io::writeFileText(mFile, text).ok());
        EXPECT_TRUE(Journal(mFile, "a").records().empty()) << text;
    }
}

TEST_F(JournalFile, WhatDoesNotFitStartsAnewAndNamesTheField) {
    PictureFacts facts;
    facts.image = "images/x.png";
    facts.errorMap = "images/x.flip.png";
    facts.linear = "images/x.exr";
    facts.counters = {{"rays traced", 7}};
    {
        Journal journal(mFile, "a");
        ASSERT_TRUE(journal.addSample("x/1", {{{"gather", 1.5}}, 3.0}).ok());
        ASSERT_TRUE(journal.setPicture("x/1", facts).ok());
    }
    const auto bytes = io::readFileBytes(mFile, 1 << 20);
    ASSERT_TRUE(bytes);
    const std::string whole(bytes.value().begin(), bytes.value().end());
    const auto expectAnew = [&](const std::string& from, const std::string& to, const char* mention
                            ) {
        std::string text = whole;
        const size_t place = text.find(from);
        ASSERT_NE(place, std::string::npos) << from;
        text.replace(place, from.size(), to);
        ASSERT_TRUE(io::writeFileText(mFile, text).ok());
        testing::internal::CaptureStderr();
        EXPECT_TRUE(Journal(mFile, "a").records().empty()) << to;
        const std::string told = testing::internal::GetCapturedStderr();
        EXPECT_NE(told.find(mention), std::string::npos) << told;
        EXPECT_NE(told.find(mFile.string()), std::string::npos) << told;
    };
    expectAnew("\"rays traced\": 7", "\"rays traced\": 1e300", "counters.rays traced");
    expectAnew("\"rays traced\": 7", "\"rays traced\": -1", "counters.rays traced");
    expectAnew("images/x.png", "/etc/hostname", "leaves the report's folder");
    expectAnew("images/x.flip.png", "../../../../x.png", "leaves the report's folder");
    expectAnew("images/x.exr", "../../../x.exr", "leaves the report's folder");
    expectAnew("\"gather\"", "\"gather\", 2", "must have 3 elements");
    expectAnew("\"samples\"", "\"more\": 1, \"samples\"", "is not a field");
    expectAnew("\"wall\": 3.0", "\"wall\": []", "wall");
}

TEST_F(JournalFile, AFolderInItsPlaceIsNoJournal) {
    std::filesystem::create_directory(mFile);
    testing::internal::CaptureStderr();
    EXPECT_TRUE(Journal(mFile, "a").records().empty());
    EXPECT_NE(testing::internal::GetCapturedStderr().find("it is a folder"), std::string::npos);
}

TEST_F(JournalFile, AFileThatCannotBeWrittenIsNamed) {
    Journal journal("no/such/folder/x.json", "a");
    const core::Status added = journal.addSample("x/1", {});
    ASSERT_FALSE(added.ok());
    EXPECT_NE(added.error().message.find("no/such/folder/x.json"), std::string::npos);
}

} // namespace shutter::bench
