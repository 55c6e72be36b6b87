// SPDX-License-Identifier: MIT
// Raw measurements of one case on disk, written after each, so that a stopped run continues
// where it was.
#pragma once

#include "engine/core/result.h"
#include "engine/render/frame_statistics.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace shutter::bench {

/// GPU time of a pass in one picture; summed where the picture takes many frames.
struct PassSample {
    std::string name;
    double milliseconds = 0.0;
    render::PassOwner owner = render::PassOwner::Scene;
};

/// One timed picture.
struct Sample {
    std::vector<PassSample> passes;
    double wallMilliseconds = 0.0; ///< with extraction, recording and waiting
};

/// How a picture compares with the truth. Values are taken after the same tone map for both.
struct PictureFacts {
    std::map<std::string, double> metrics; ///< by id; a PSNR of equal pictures is infinite
    std::string image;                     ///< file relative to the report's folder
    std::string errorMap;                  ///< likewise
    std::string linear; ///< likewise, the linear picture; empty if it was not stored
    std::map<std::string, uint64_t> counters;
};

/// Everything known about a method at one sample count.
struct Record {
    std::vector<Sample> samples;
    bool hasPicture = false;
    PictureFacts picture;
    std::string skipped; ///< why it was not measured; empty where it was
};

class Journal {
  public:
    /// Reads the records of an earlier run, unless its fingerprint differs.
    /// \param fingerprint everything that makes measurements comparable
    Journal(std::filesystem::path file, std::string fingerprint);

    [[nodiscard]] const std::map<std::string, Record>& records() const { return mRecords; }

    /// The record of a key, empty at first.
    [[nodiscard]] const Record& find(const std::string& key) const;

    /// Each writes the file. Error: it cannot be written.
    [[nodiscard]] core::Status addSample(const std::string& key, Sample sample);
    [[nodiscard]] core::Status setPicture(const std::string& key, PictureFacts picture);
    [[nodiscard]] core::Status skip(const std::string& key, const std::string& reason);
    /// Replaces the records of the keys, in a single write.
    [[nodiscard]] core::Status setRecords(std::map<std::string, Record> records);

  private:
    [[nodiscard]] core::Status save() const;

    std::filesystem::path mFile;
    std::string mFingerprint;
    std::map<std::string, Record> mRecords;
};

} // namespace shutter::bench
