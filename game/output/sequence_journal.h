// SPDX-License-Identifier: MIT
// Records the complete frames of a sequence on disk, so that an interrupted run resumes. One line
// of JSON per frame, added when all of the frame's files exist; a frame is complete if its files
// still match the line.
#pragma once

#include "engine/core/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

/// Path of the journal of the pictures `pattern`: a hidden file in their folder.
[[nodiscard]] std::filesystem::path journalFile(const std::filesystem::path& pattern);

class SequenceJournal {
  public:
    /// State left by an earlier run.
    enum class Before : uint8_t { Nothing, SamePictures, OtherPictures };

    /// Begins an empty journal unless there is one of the same fingerprint.
    /// \param fingerprint differs wherever a picture may; printable ASCII
    /// Error: the journal cannot be written.
    [[nodiscard]] static core::Result<SequenceJournal>
    open(std::filesystem::path file, const std::string& fingerprint);

    /// Reads the journal of this fingerprint without writing: another process may be appending to
    /// it. Empty where there is none. Error: the file cannot be read.
    [[nodiscard]] static core::Result<SequenceJournal>
    read(std::filesystem::path file, const std::string& fingerprint);

    [[nodiscard]] Before before() const { return mBefore; }

    /// Whether all files of the frame, including its own picture, are unchanged since it was added:
    /// a line may name others. Reads them.
    /// \param picture as passed to add()
    [[nodiscard]] bool isComplete(int frame, const std::filesystem::path& picture) const;

    /// \param files in the journal's folder or below, complete
    /// Error: a file cannot be read, or the journal cannot be written.
    [[nodiscard]] core::Status add(int frame, const std::vector<std::filesystem::path>& files);

    /// Adds a frame that `other`, a journal in the same folder, has as complete, if it has it.
    /// Error: the journal cannot be written.
    [[nodiscard]] core::Status addFrom(const SequenceJournal& other, int frame);

    /// Frames that were added, regardless of their files.
    [[nodiscard]] size_t frameCount() const { return mFrames.size(); }

    [[nodiscard]] const std::filesystem::path& file() const { return mFile; }

  private:
    struct File {
        std::string name; ///< from the journal's folder
        std::string hash;
    };

    SequenceJournal(std::filesystem::path file, Before before)
        : mFile(std::move(file)), mBefore(before) {}

    /// False where there is no file, and where readLines() is false.
    core::Result<bool> readFile(const std::string& fingerprint);
    /// False where a line is broken, as the last of a killed run may be.
    bool readLines(std::string_view text, const std::string& fingerprint);
    [[nodiscard]] core::Status rewrite(const std::string& fingerprint) const;
    /// As lines name it.
    [[nodiscard]] std::string nameInFolder(const std::filesystem::path& file) const;
    [[nodiscard]] static std::string formatLine(int frame, const std::vector<File>& files);

    std::filesystem::path mFile;
    Before mBefore = Before::Nothing;
    std::map<int, std::vector<File>> mFrames;
};

} // namespace shutter::game
