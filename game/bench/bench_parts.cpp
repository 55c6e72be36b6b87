// SPDX-License-Identifier: MIT
#include "game/bench/bench_parts.h"

#include "engine/core/check.h"
#include "engine/io/file_bytes.h"
#include "engine/json/json_file.h"
#include "game/bench/bench_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int64_t kVersion = 1;
constexpr size_t kMaxWords = 4096;
constexpr size_t kMaxParts = 10000;
constexpr uint64_t kMaxResultsBytes = 256ULL << 20;

/// Fields of the results that hold one entry for each part, or for some.
constexpr const char* kLists[] = {
    "cases", "equalTime", "scaling", "sequences", "stability", "demand"};

template <class T>
void listNames(const std::vector<T>& all, const char* kind, std::vector<std::string>& names) {
    for (const T& one : all)
        names.push_back(fmt::format("{} {}", kind, one.name));
}

/// Leaves the entry of that place, or none, and counts the place on to the next list's: below 0
/// once it was found.
template <class T> void keepOne(std::vector<T>& all, int64_t& place) {
    const auto count = int64_t(all.size());
    std::vector<T> kept;
    if (place >= 0 && place < count)
        kept.push_back(std::move(all[size_t(place)]));
    all = std::move(kept);
    place -= count;
}

core::Result<json> readPartResults(const fs::path& file) {
    const auto bytes = io::readFileBytes(file, kMaxResultsBytes);
    if (!bytes)
        return bytes.error();
    json results = json::parse(bytes.value(), nullptr, false);
    if (!results.is_object() || !results.contains("machine") || !results.contains("created"))
        return core::makeError("'{}' is damaged; --restart measures anew", file.string());
    return results;
}

core::Result<std::string> computeFingerprint(const BenchPlan& plan) {
    const auto program = io::computeFileHash("/proc/self/exe");
    if (!program)
        return program.error();
    return io::computeContentHash(fmt::format(
        "program {} folder {} words {} parts {}",
        program.value(),
        plan.folder.string(),
        fmt::join(plan.words, "\n"),
        fmt::join(plan.parts, "\n")
    ));
}

core::Status writePlan(const fs::path& file, const BenchPlan& plan) {
    nlohmann::ordered_json root;
    root["version"] = kVersion;
    root["fingerprint"] = plan.fingerprint;
    root["folder"] = plan.folder.string();
    root["options"] = plan.words;
    root["parts"] = plan.parts;
    root["processes"] = plan.processes;
    root["slurm"] = plan.isSlurm;
    return shutter::json::writeJsonFile(file, root);
}

core::Result<BenchPlan> readPlan(const fs::path& file) {
    return shutter::json::readJsonFile(file, [](const shutter::json::JsonNode& root) {
        BenchPlan plan;
        const auto object = root.readObject(
            {"version", "fingerprint", "folder", "options", "parts", "processes", "slurm"}
        );
        (void)object.require("version").readInteger(kVersion, kVersion);
        plan.fingerprint = object.require("fingerprint").readString();
        plan.folder = object.require("folder").readString();
        for (const auto& word : object.require("options").readArray(1, kMaxWords))
            plan.words.push_back(word.readString());
        for (const auto& part : object.require("parts").readArray(1, kMaxParts))
            plan.parts.push_back(part.readString());
        plan.processes = uint32_t(object.require("processes").readInteger(1, kMaxParts));
        plan.isSlurm = object.require("slurm").readBoolean();
        return plan;
    });
}

/// One that holds other files stays.
void removeFolder(const BenchPlan& plan, const fs::path& folder) {
    const auto partCount = uint32_t(plan.parts.size());
    std::error_code ignored;
    for (uint32_t part = 0; part < partCount; ++part)
        fs::remove(partResults(folder, part), ignored);
    fs::remove(benchPlanFile(folder), ignored);
    parts::removePartFiles(folder, partCount);
    fs::remove(folder, ignored);
}

} // namespace

fs::path findBenchFolder(const fs::path& out) {
    std::error_code ignored;
    return fs::absolute(out / "parts", ignored).lexically_normal();
}

fs::path benchPlanFile(const fs::path& folder) {
    return folder / "plan.json";
}

fs::path partResults(const fs::path& folder, uint32_t part) {
    return folder / fmt::format("part_{}.json", part);
}

std::vector<std::string> listBenchParts(const Suite& suite) {
    std::vector<std::string> names;
    listNames(suite.cases, "case", names);
    listNames(suite.axes, "axis", names);
    listNames(suite.sequences, "sequence", names);
    listNames(suite.hardCases, "hard case", names);
    listNames(suite.claims, "claim", names);
    return names;
}

Suite keepBenchPart(Suite suite, uint32_t part) {
    SHUTTER_CHECK(part < listBenchParts(suite).size(), "part {}", part);
    int64_t place = part;
    keepOne(suite.cases, place);
    keepOne(suite.axes, place);
    keepOne(suite.sequences, place);
    keepOne(suite.hardCases, place);
    keepOne(suite.claims, place);
    return suite;
}

core::Result<BenchPlan> makeBenchPlan(
    std::vector<std::string> words, std::vector<std::string> parts, const parts::JobOptions& jobs
) {
    std::error_code failure;
    BenchPlan plan;
    plan.folder = fs::current_path(failure);
    if (failure)
        return core::makeError("cannot tell the folder that this is: {}", failure.message());
    plan.words = std::move(words);
    plan.parts = std::move(parts);
    plan.isSlurm = jobs.slurm;
    plan.processes = jobs.slurm ? uint32_t(plan.parts.size()) : jobs.jobs;
    auto fingerprint = computeFingerprint(plan);
    if (!fingerprint)
        return fingerprint.error();
    plan.fingerprint = std::move(fingerprint.value());
    return plan;
}

core::Status keepBenchPlan(BenchPlan& plan, const fs::path& folder, bool restart) {
    const fs::path file = benchPlanFile(folder);
    std::error_code failure;
    if (restart)
        fs::remove_all(folder, failure);
    if (fs::exists(file, failure)) {
        const auto before = readPlan(file);
        if (!before)
            return before.error();
        if (before.value().fingerprint != plan.fingerprint)
            return core::makeError(
                "--out: '{}' holds a benchmark that was planned otherwise; --restart measures this "
                "one instead",
                folder.string()
            );
        plan.processes = std::max(plan.processes, before.value().processes);
        plan.isSlurm = plan.isSlurm || before.value().isSlurm;
    }
    fs::create_directories(folder, failure);
    if (failure)
        return core::makeError(
            "--out: cannot make the folder '{}': {}", folder.string(), failure.message()
        );
    return writePlan(file, plan);
}

core::Result<BenchPlan> openBenchPlan(const fs::path& folder) {
    auto plan = readPlan(benchPlanFile(folder));
    if (!plan)
        return plan;
    const auto fingerprint = computeFingerprint(plan.value());
    if (!fingerprint)
        return fingerprint.error();
    if (fingerprint.value() != plan.value().fingerprint)
        return core::makeError(
            "{}: this program is not the one that the benchmark was planned with",
            benchPlanFile(folder).string()
        );
    std::error_code failure;
    fs::current_path(plan.value().folder, failure);
    if (failure)
        return core::makeError(
            "the folder '{}' cannot be entered: {}", plan.value().folder.string(), failure.message()
        );
    return plan;
}

parts::PartWork describeBenchWork(const BenchPlan& plan, const fs::path& folder) {
    const auto partCount = uint32_t(plan.parts.size());
    const auto listUnfinished = [folder, partCount] {
        std::vector<uint32_t> unfinished;
        std::error_code ignored;
        for (uint32_t part = 0; part < partCount; ++part)
            if (!fs::exists(partResults(folder, part), ignored))
                unfinished.push_back(part);
        return unfinished;
    };
    parts::PartWork work;
    work.noun = kBenchNoun;
    work.verb = "measuring";
    work.name = "shutter-bench";
    work.folder = folder;
    work.start = plan.folder;
    work.partCommand = kBenchPartCommand;
    work.finishCommand = kBenchFinishCommand;
    work.stepCount = partCount;
    work.countDone = [listUnfinished, partCount] { return partCount - listUnfinished().size(); };
    work.isFinished = [folder] {
        std::error_code ignored; // who finishes removes the plan
        return !fs::exists(benchPlanFile(folder), ignored);
    };
    work.listUnfinished = [listUnfinished]() -> core::Result<std::vector<uint32_t>> {
        return listUnfinished();
    };
    return work;
}

core::Result<json> mergeBenchParts(const BenchPlan& plan, const fs::path& folder) {
    json merged;
    std::set<std::string> machines;
    for (uint32_t part = 0; part < plan.parts.size(); ++part) {
        auto results = readPartResults(partResults(folder, part));
        if (!results)
            return core::makeError(
                "part {}, {}, is not measured: {}", part, plan.parts[part], results.error().message
            );
        machines.insert(results.value().at("machine").value("cpu", std::string()));
        if (merged.is_null()) {
            merged = std::move(results.value());
            continue;
        }
        for (const char* list : kLists) {
            if (!results.value().contains(list))
                continue;
            for (json& entry : results.value()[list])
                merged[list].push_back(std::move(entry));
        }
        merged["created"] = std::max(
            merged.at("created").get<std::string>(),
            results.value().at("created").get<std::string>()
        );
    }
    if (plan.processes > 1)
        merged["parallel"] = {
            {"processes", plan.processes}, {"slurm", plan.isSlurm}, {"machines", machines}};
    return merged;
}

core::Status finishBench(const BenchPlan& plan, const fs::path& folder) {
    const auto merged = mergeBenchParts(plan, folder);
    if (!merged)
        return merged.error();
    SHUTTER_TRY(writeReport(merged.value(), folder.parent_path()));
    removeFolder(plan, folder);
    return judgeResults(merged.value());
}

} // namespace shutter::bench
