// SPDX-License-Identifier: MIT
// A benchmark in parts, each by a process of its own: a part is a case, an axis, a hard case or a
// claim, and leaves results of itself alone in the working folder. They are merged into the
// report's results.json. What was measured of a case lies in its journal, as without parts.
#pragma once

#include "engine/core/result.h"
#include "game/bench/suites/suite.h"
#include "game/parts/job_options.h"
#include "game/parts/part_work.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shutter::bench {

/// What sentences call it.
inline constexpr const char* kBenchNoun = "benchmark";
/// The hidden commands of the processes that measure and that merge.
inline constexpr const char* kBenchPartCommand = "bench-part";
inline constexpr const char* kBenchFinishCommand = "bench-finish";

struct BenchPlan {
    std::string fingerprint;        ///< of this program and all below but who works
    std::filesystem::path folder;   ///< absolute; relative paths among `words` start there
    std::vector<std::string> words; ///< arguments of `shutter bench`
    std::vector<std::string> parts; ///< what each measures: "case spin"
    uint32_t processes = 1;         ///< that may measure at once
    bool isSlurm = false;           ///< and Slurm says where
};

/// The working folder of a report's folder: inside it.
[[nodiscard]] std::filesystem::path findBenchFolder(const std::filesystem::path& out);

[[nodiscard]] std::filesystem::path benchPlanFile(const std::filesystem::path& folder);
/// The results of a part; there once it is measured.
[[nodiscard]] std::filesystem::path partResults(const std::filesystem::path& folder, uint32_t part);

/// The names of a suite's parts.
[[nodiscard]] std::vector<std::string> listBenchParts(const Suite& suite);

/// The suite without all but one part.
/// \param part its place among listBenchParts(), CHECKed
[[nodiscard]] Suite keepBenchPart(Suite suite, uint32_t part);

/// A plan of a run from here. Error: this program cannot be read.
/// \param words all that was typed but who works
[[nodiscard]] core::Result<BenchPlan> makeBenchPlan(
    std::vector<std::string> words, std::vector<std::string> parts, const parts::JobOptions& jobs
);

/// Writes the plan into its working folder, or goes on with what is there; then the plan learns
/// how many processes have taken part before.
/// \param restart nothing of what is there is kept
/// Error: another plan is there, or a file cannot be read or written.
[[nodiscard]] core::Status
keepBenchPlan(BenchPlan& plan, const std::filesystem::path& folder, bool restart);

/// Reads the plan and goes to the folder that its options start from.
/// Error: there is none, it is damaged, or it is another program's.
[[nodiscard]] core::Result<BenchPlan> openBenchPlan(const std::filesystem::path& folder);

/// What game/parts needs to know of it.
[[nodiscard]] parts::PartWork
describeBenchWork(const BenchPlan& plan, const std::filesystem::path& folder);

/// The results of all parts as those of one run, marked as measured by several processes where they
/// were. Error: a part is not measured or its file is damaged; names it.
[[nodiscard]] core::Result<nlohmann::json>
mergeBenchParts(const BenchPlan& plan, const std::filesystem::path& folder);

/// Merges the parts into the report and removes the working folder.
/// Error: as mergeBenchParts(), a file cannot be written, or what was measured left its bounds.
[[nodiscard]] core::Status finishBench(const BenchPlan& plan, const std::filesystem::path& folder);

} // namespace shutter::bench
