// SPDX-License-Identifier: MIT
// Records what of a sequence is complete on disk, so that a stopped run continues where it was. A
// line of JSON per frame, added when all of the frame's files are in place; a frame counts when
// its files still have the bytes that its line tells.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

/// Where the journal of the pictures `pattern` lies: hidden, beside them.
[[nodiscard]] std::filesystem::path journalFile(const std::filesystem::path& pattern);

class SequenceJournal {
  public:
    /// What an earlier run left.
    enum class Before : uint8_t { Nothing, SamePictures, OtherPictures };

    /// Begins an empty journal unless there is one of the same fingerprint.
    /// \param fingerprint differs wherever a picture may; printable ASCII
    /// Error: the journal cannot be written.
    [[nodiscard]] static core::Result<SequenceJournal>
    open(std::filesystem::path file, const std::string& fingerprint);

    [[nodiscard]] Before before() const { return mBefore; }

    /// Whether all files of the frame are what they were when it was added, its own picture among
    /// them: a line may name others. Reads them.
    /// \param picture as it was given to add()
    [[nodiscard]] bool isComplete(int frame, const std::filesystem::path& picture) const;

    /// \param files in the journal's folder or below, complete
    /// Error: a file cannot be read, or the journal cannot be written.
    [[nodiscard]] core::Status add(int frame, const std::vector<std::filesystem::path>& files);

    [[nodiscard]] const std::filesystem::path& file() const { return mFile; }

  private:
    struct File {
        std::string name; ///< from the journal's folder
        std::string hash;
    };

    SequenceJournal(std::filesystem::path file, Before before)
        : mFile(std::move(file)), mBefore(before) {}

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
