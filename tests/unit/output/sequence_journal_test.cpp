// SPDX-License-Identifier: MIT
// Journals of sequences, time codes, and files of statistics.
#include "engine/io/file_bytes.h"
#include "game/output/render_options.h"
#include "game/output/sequence_journal.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace shutter::game {
namespace {

namespace fs = std::filesystem;
using Before = SequenceJournal::Before;

class JournalOfASequence : public testing::Test {
  protected:
    fs::path write(const std::string& name, const std::string& text) const {
        std::ofstream(mFolder / name, std::ios::binary) << text;
        return mFolder / name;
    }

    [[nodiscard]] SequenceJournal open(const std::string& fingerprint) const {
        auto opened = SequenceJournal::open(file(), fingerprint);
        EXPECT_TRUE(opened.ok());
        return std::move(opened).value();
    }

    [[nodiscard]] bool isComplete(const SequenceJournal& journal, int frame) const {
        return journal.isComplete(frame, frameFile(mFolder / "f_%04d.png", frame));
    }

    [[nodiscard]] fs::path file() const { return journalFile(mFolder / "f_%04d.png"); }

    [[nodiscard]] std::string text() const {
        std::ifstream stream(file(), std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    const test::TempFolder mTemporary;
    const fs::path mFolder = mTemporary.path();
};

TEST_F(JournalOfASequence, AReopenedJournalHasTheCompleteFrames) {
    {
        SequenceJournal journal = open("a");
        EXPECT_EQ(journal.before(), Before::Nothing);
        EXPECT_FALSE(isComplete(journal, 3));
        ASSERT_TRUE(journal.add(3, {write("f_0003.png", "x"), write("f_0003.mask.exr", "y")}).ok());
        ASSERT_TRUE(journal.add(-1, {write("f_-001.png", "z")}).ok());
        EXPECT_TRUE(isComplete(journal, 3));
    }
    const SequenceJournal again = open("a");
    EXPECT_EQ(again.before(), Before::SamePictures);
    EXPECT_TRUE(isComplete(again, 3));
    EXPECT_TRUE(isComplete(again, -1));
    EXPECT_FALSE(isComplete(again, 4));
    write("f_0003.mask.exr", "Y");
    EXPECT_FALSE(isComplete(again, 3)) << "one of its files was changed";
    fs::remove(mFolder / "f_-001.png");
    EXPECT_FALSE(isComplete(again, -1)) << "its file is gone";
}

TEST_F(JournalOfASequence, AnotherFingerprintStartsANewJournal) {
    ASSERT_TRUE(open("a").add(0, {write("f_0000.png", "x")}).ok());
    const SequenceJournal other = open("b");
    EXPECT_EQ(other.before(), Before::OtherPictures);
    EXPECT_FALSE(isComplete(other, 0));
    EXPECT_FALSE(isComplete(open("b"), 0));
    EXPECT_EQ(open("a").before(), Before::OtherPictures);
}

TEST_F(JournalOfASequence, ATruncatedJournalStaysValid) {
    {
        SequenceJournal journal = open("a");
        for (int frame = 0; frame < 3; ++frame) {
            const std::string name = "f_000" + std::to_string(frame) + ".png";
            ASSERT_TRUE(journal.add(frame, {write(name, name)}).ok());
        }
    }
    const std::string whole = text();
    for (size_t bytes = 0; bytes <= whole.size(); ++bytes) {
        ASSERT_TRUE(io::writeFileText(file(), whole.substr(0, bytes)).ok());
        const auto lines = std::count(whole.begin(), whole.begin() + std::ptrdiff_t(bytes), '\n');
        SequenceJournal journal = open("a");
        for (int frame = 0; frame < 3; ++frame)
            ASSERT_EQ(isComplete(journal, frame), frame < lines - 1) << bytes;
        // And goes on from there.
        ASSERT_TRUE(journal.add(2, {mFolder / "f_0002.png"}).ok());
        ASSERT_TRUE(isComplete(open("a"), 2)) << bytes;
    }
}

TEST_F(JournalOfASequence, AJournalIsReadWithoutWriting) {
    const auto missing = SequenceJournal::read(file(), "a");
    ASSERT_TRUE(missing.ok());
    EXPECT_EQ(missing.value().frameCount(), 0u);
    EXPECT_FALSE(fs::exists(file()));
    ASSERT_TRUE(open("a").add(2, {write("f_0002.png", "x")}).ok());
    const std::string cut = text() + "{\"files\": ["; // another process is adding to it
    ASSERT_TRUE(io::writeFileText(file(), cut).ok());
    const auto read = SequenceJournal::read(file(), "a");
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read.value().frameCount(), 1u);
    EXPECT_TRUE(isComplete(read.value(), 2));
    const auto other = SequenceJournal::read(file(), "b");
    ASSERT_TRUE(other.ok());
    EXPECT_EQ(other.value().frameCount(), 0u);
    EXPECT_EQ(text(), cut);
}

TEST_F(JournalOfASequence, FramesOfAnotherJournalAreMerged) {
    SequenceJournal part = open("a");
    ASSERT_TRUE(part.add(2, {write("f_0002.png", "x")}).ok());
    const fs::path wholeFile = mFolder / ".whole.journal";
    {
        auto whole = SequenceJournal::open(wholeFile, "a");
        ASSERT_TRUE(whole.ok());
        ASSERT_TRUE(whole.value().addFrom(part, 2).ok());
        ASSERT_TRUE(whole.value().addFrom(part, 3).ok());
        EXPECT_EQ(whole.value().frameCount(), 1u);
    }
    const auto again = SequenceJournal::read(wholeFile, "a");
    ASSERT_TRUE(again.ok());
    EXPECT_TRUE(isComplete(again.value(), 2));
    EXPECT_FALSE(isComplete(again.value(), 3));
}

TEST_F(JournalOfASequence, AnInvalidFileStartsANewJournal) {
    ASSERT_TRUE(open("a").add(0, {write("f_0000.png", "x")}).ok());
    const std::string header = text().substr(0, text().find('\n') + 1);
    for (const std::string& wrong :
         {std::string("\n"),
          std::string("[]\n"),
          std::string("{\"journal\": \"another\", \"fingerprint\": \"a\"}\n"),
          header + "{\"frame\": \"0\", \"files\": []}\n",
          header + "{\"frame\": 0, \"files\": []}\n",
          header + "{\"frame\": 1e300, \"files\": [{\"name\": \"x\", \"hash\": \"y\"}]}\n",
          header + "\xFF\xFE\n"}) {
        ASSERT_TRUE(io::writeFileText(file(), wrong).ok());
        EXPECT_FALSE(isComplete(open("a"), 0)) << wrong;
        EXPECT_EQ(text(), header) << wrong;
    }
}

TEST_F(JournalOfASequence, FilesOutsideTheFolderAreNoFrames) {
    const fs::path outside = mFolder.parent_path() / "sequence_outside.png";
    std::ofstream(outside) << "x";
    const std::string hash = io::computeFileHash(outside).value();
    (void)open("a");
    const std::string header = text();
    for (const std::string& name : {std::string("../sequence_outside.png"), outside.string()}) {
        const std::string line = "{\"frame\": 0, \"files\": [{\"name\": \"" + name +
                                 "\", \"hash\": \"" + hash + "\"}]}\n";
        ASSERT_TRUE(io::writeFileText(file(), header + line).ok());
        EXPECT_FALSE(isComplete(open("a"), 0)) << name;
        EXPECT_EQ(text(), header) << "its line is gone";
    }
    fs::remove(outside);
}

TEST_F(JournalOfASequence, AnothersPictureCompletesNoFrame) {
    SequenceJournal journal = open("a");
    const fs::path first = write("f_0000.png", "x");
    ASSERT_TRUE(journal.add(0, {first}).ok());
    ASSERT_TRUE(journal.add(1, {first}).ok());
    ASSERT_TRUE(journal.add(2, {first, write("f_0002.png", "y")}).ok());
    const SequenceJournal again = open("a");
    EXPECT_TRUE(isComplete(again, 0));
    EXPECT_FALSE(isComplete(again, 1)) << "its line names the picture of frame 0 alone";
    EXPECT_TRUE(isComplete(again, 2));
}

TEST_F(JournalOfASequence, UnreadableOrUnwritableJournalsAreNamed) {
    const auto nowhere = SequenceJournal::open(mFolder / "no/such/.journal", "a");
    ASSERT_FALSE(nowhere.ok());
    EXPECT_NE(nowhere.error().message.find("no/such/.journal"), std::string::npos);
    SequenceJournal journal = open("a");
    const core::Status missing = journal.add(0, {mFolder / "missing.png"});
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message.find("missing.png"), std::string::npos);
    fs::remove(file());
    const core::Status gone = journal.add(0, {write("f_0000.png", "x")});
    ASSERT_FALSE(gone.ok());
    EXPECT_NE(gone.error().message.find(".f_%04d.png.journal"), std::string::npos);
}

TEST(SequenceJournalFile, TheJournalIsAHiddenFileNextToThePictures) {
    EXPECT_EQ(journalFile("f_%04d.png"), ".f_%04d.png.journal");
    EXPECT_EQ(journalFile("out/f_%04d.png"), "out/.f_%04d.png.journal");
    EXPECT_EQ(journalFile("/a/b/f_%d.exr"), "/a/b/.f_%d.exr.journal");
    EXPECT_EQ(journalFile("out %d/f_%04d.png"), "out %d/.f_%04d.png.journal");
    const std::string longest(251, 'x');
    EXPECT_LE(journalFile(longest).string().size(), 255u);
}

RenderOptions makeOptions(const std::string& timecode, core::FrameRate fps) {
    RenderOptions options;
    options.output.video.timecode = timecode;
    options.shot.fps = fps;
    return options;
}

/// The code of a frame, or why it has none; "-" without --timecode.
std::string find(const RenderOptions& options, size_t frame) {
    const auto found = findTimecode(options, frame);
    if (!found)
        return found.error().message;
    return found.value() ? describe(*found.value()) : "-";
}

TEST(TimecodeTest, TimecodesCountFramesSecondsMinutesHoursAndDays) {
    const RenderOptions options = makeOptions("01:02:03:20", 24.0);
    EXPECT_EQ(find(options, 0), "01:02:03:20");
    EXPECT_EQ(find(options, 3), "01:02:03:23");
    EXPECT_EQ(find(options, 4), "01:02:04:00");
    EXPECT_EQ(find(options, 24 * 57), "01:03:00:20");
    EXPECT_EQ(find(makeOptions("23:59:59:29", 29.97), 1), "00:00:00:00");
    EXPECT_EQ(find(makeOptions("00:59:59:20", {24000.0, 1001.0}), 24), "01:00:00:20");
    EXPECT_EQ(find(makeOptions("", 24.0), 5), "-");
}

TEST(TimecodeTest, TheTimecodeBeginsAtTheGivenOne) {
    RenderOptions options = makeOptions("frame", 25.0);
    options.shot.firstFrame = 1001;
    EXPECT_EQ(find(options, 0), "00:00:40:01");
    EXPECT_EQ(find(options, 24), "00:00:41:00");
    options.shot.firstFrame = -1;
    EXPECT_EQ(find(options, 0), "--timecode frame: frame -1 has none");
}

TEST(TimecodeTest, InvalidTimesAreRefused) {
    EXPECT_EQ(
        find(makeOptions("00:00:00:24", 24.0), 0),
        "--timecode 00:00:00:24: a second has 24 frames, numbered from 0"
    );
    EXPECT_EQ(
        find(makeOptions("24:00:00:00", 24.0), 0),
        "--timecode 24:00:00:00: a day has 24 hours, numbered from 0"
    );
    EXPECT_EQ(
        find(makeOptions("00:00:00:00", 60.0), 0),
        "--timecode: an EXR's counts 30 frames a second at most, and --fps is 60"
    );
    EXPECT_EQ(
        find(makeOptions("00:00:00:00", {60000.0, 1001.0}), 0),
        "--timecode: an EXR's counts 30 frames a second at most, and --fps is 60000/1001"
    );
    EXPECT_EQ(
        find(makeOptions("00:00:00:01", 1.0), 0),
        "--timecode 00:00:00:01: a second has 1 frame, numbered from 0"
    );
    RenderOptions film = makeOptions("00:00:00:59", 60.0);
    film.output.film = "film.mp4";
    EXPECT_EQ(find(film, 1), "00:00:01:00");
}

TEST(FrameStampTest, OnlyFramesOfASequenceHaveAStamp) {
    RenderOptions options = makeOptions("01:02:03:20", {24000.0, 1001.0});
    options.shot.isSequence = true;
    const auto stamp = findStamp(options, 4);
    ASSERT_TRUE(stamp.ok() && stamp.value());
    EXPECT_EQ(stamp.value()->rate, core::FrameRate(24000.0, 1001.0));
    EXPECT_EQ(describe(stamp.value()->timecode.value()), "01:02:04:00");
    options.output.video.timecode.clear();
    const auto untimed = findStamp(options, 0);
    ASSERT_TRUE(untimed.ok() && untimed.value());
    EXPECT_FALSE(untimed.value()->timecode);
    options.shot.isSequence = false;
    const auto single = findStamp(options, 0);
    ASSERT_TRUE(single.ok());
    EXPECT_FALSE(single.value());
}

} // namespace
} // namespace shutter::game
