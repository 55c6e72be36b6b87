// SPDX-License-Identifier: MIT
// Journals of sequences, time codes, and intermediates that can be written.
#include "engine/io/file_bytes.h"
#include "game/output/extra_files.h"
#include "game/output/render_options.h"
#include "game/output/sequence_journal.h"
#include "game/shot/picture_drawer.h"
#include "tests/support/outcomes.h"
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
        return mTemporary.write(name, text);
    }

    [[nodiscard]] SequenceJournal open(const std::string& fingerprint) const {
        return test::valueOf(SequenceJournal::open(file(), fingerprint));
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
    EXPECT_EQ(test::valueOf(SequenceJournal::read(file(), "a")).frameCount(), 0u);
    EXPECT_FALSE(fs::exists(file()));
    ASSERT_TRUE(open("a").add(2, {write("f_0002.png", "x")}).ok());
    const std::string cut = text() + "{\"files\": ["; // another process is adding to it
    ASSERT_TRUE(io::writeFileText(file(), cut).ok());
    const auto read = test::valueOf(SequenceJournal::read(file(), "a"));
    EXPECT_EQ(read.frameCount(), 1u);
    EXPECT_TRUE(isComplete(read, 2));
    EXPECT_EQ(test::valueOf(SequenceJournal::read(file(), "b")).frameCount(), 0u);
    EXPECT_EQ(text(), cut);
}

TEST_F(JournalOfASequence, FramesOfAnotherJournalAreMerged) {
    SequenceJournal part = open("a");
    ASSERT_TRUE(part.add(2, {write("f_0002.png", "x")}).ok());
    const fs::path wholeFile = mFolder / ".whole.journal";
    {
        auto whole = test::valueOf(SequenceJournal::open(wholeFile, "a"));
        ASSERT_TRUE(whole.addFrom(part, 2).ok());
        ASSERT_TRUE(whole.addFrom(part, 3).ok());
        EXPECT_EQ(whole.frameCount(), 1u);
    }
    const auto again = test::valueOf(SequenceJournal::read(wholeFile, "a"));
    EXPECT_TRUE(isComplete(again, 2));
    EXPECT_FALSE(isComplete(again, 3));
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
    const test::TempFolder other;
    const fs::path outside = other.write("outside.png", "x");
    const std::string hash = io::computeFileHash(outside).value();
    (void)open("a");
    const std::string header = text();
    const fs::path above = ".." / other.path().filename() / "outside.png";
    for (const std::string& name : {above.string(), outside.string()}) {
        const std::string line = "{\"frame\": 0, \"files\": [{\"name\": \"" + name +
                                 "\", \"hash\": \"" + hash + "\"}]}\n";
        ASSERT_TRUE(io::writeFileText(file(), header + line).ok());
        EXPECT_FALSE(isComplete(open("a"), 0)) << name;
        EXPECT_EQ(text(), header) << "its line is gone";
    }
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
    test::expectRefused(
        SequenceJournal::open(mFolder / "no/such/.journal", "a"), "no/such/.journal"
    );
    SequenceJournal journal = open("a");
    test::expectRefused(journal.add(0, {mFolder / "missing.png"}), "missing.png");
    fs::remove(file());
    test::expectRefused(journal.add(0, {write("f_0000.png", "x")}), ".f_%04d.png.journal");
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

TEST(TimecodeTest, TimecodesCountFramesToDaysFromTheGivenOne) {
    const RenderOptions options = makeOptions("01:02:03:20", 24.0);
    EXPECT_EQ(find(options, 0), "01:02:03:20");
    EXPECT_EQ(find(options, 3), "01:02:03:23");
    EXPECT_EQ(find(options, 4), "01:02:04:00");
    EXPECT_EQ(find(options, 24 * 57), "01:03:00:20");
    EXPECT_EQ(find(makeOptions("23:59:59:29", 29.97), 1), "00:00:00:00");
    EXPECT_EQ(find(makeOptions("00:59:59:20", {24000.0, 1001.0}), 24), "01:00:00:20");
    EXPECT_EQ(find(makeOptions("", 24.0), 5), "-");
    RenderOptions numbered = makeOptions("frame", 25.0);
    numbered.shot.firstFrame = 1001;
    EXPECT_EQ(find(numbered, 0), "00:00:40:01");
    EXPECT_EQ(find(numbered, 24), "00:00:41:00");
    numbered.shot.firstFrame = -1;
    EXPECT_EQ(find(numbered, 0), "--timecode frame: frame -1 has none");
}

TEST(TimecodeTest, InvalidTimesAreRefused) {
    struct Row {
        const char* timecode;
        core::FrameRate fps;
        const char* sentence;
    };

    const Row kRows[] = {
        {"00:00:00:24", 24.0, " 00:00:00:24: a second has 24 frames, numbered from 0"},
        {"24:00:00:00", 24.0, " 24:00:00:00: a day has 24 hours, numbered from 0"},
        {"00:00:00:01", 1.0, " 00:00:00:01: a second has 1 frame, numbered from 0"},
        {"00:00:00:00", 60.0, ": an EXR's counts 30 frames a second at most, and --fps is 60"},
        {"00:00:00:00",
         {60000.0, 1001.0},
         ": an EXR's counts 30 frames a second at most, and --fps is 60000/1001"}};
    for (const Row& row : kRows)
        EXPECT_EQ(
            find(makeOptions(row.timecode, row.fps), 0), "--timecode" + std::string(row.sentence)
        );
    RenderOptions film = makeOptions("00:00:00:59", 60.0);
    film.output.film = "film.mp4";
    EXPECT_EQ(find(film, 1), "00:00:01:00");
}

TEST(FrameStampTest, OnlyFramesOfASequenceHaveAStamp) {
    RenderOptions options = makeOptions("01:02:03:20", {24000.0, 1001.0});
    options.shot.isSequence = true;
    const auto stamp = test::valueOf(findStamp(options, 4)).value();
    EXPECT_EQ(stamp.rate, core::FrameRate(24000.0, 1001.0));
    EXPECT_EQ(describe(stamp.timecode.value()), "01:02:04:00");
    options.output.video.timecode.clear();
    EXPECT_FALSE(test::valueOf(findStamp(options, 0)).value().timecode);
    options.shot.isSequence = false;
    EXPECT_FALSE(test::valueOf(findStamp(options, 0)));
}

TEST(Intermediates, AllIntermediatesOfAMethodCanBeWrittenAndViewed) {
    for (const MethodInfo& method : listMethods())
        for (const std::string& name : listIntermediates(method)) {
            const debug_view::ViewInfo* view = debug_view::findView(name);
            ASSERT_TRUE(view) << method.name << " has " << name;
            EXPECT_FALSE(view->channels.empty()) << name;
            EXPECT_EQ(debug_view::listSources(name), std::set{name});
        }
}

} // namespace
} // namespace shutter::game
