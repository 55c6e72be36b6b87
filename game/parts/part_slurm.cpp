// SPDX-License-Identifier: MIT
#include "game/parts/part_slurm.h"

#include "engine/io/file_bytes.h"
#include "engine/io/process.h"
#include "engine/json/json_file.h"
#include "game/parts/part_progress.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace shutter::parts {

namespace fs = std::filesystem;

using core::makeError;

namespace {

/// Ids of jobs, as sbatch tells them.
struct SlurmJobs {
    std::string parts; ///< of the array; empty: every part was complete
    std::string finish;
};

/// Between two questions to the controller, which serves a whole cluster.
constexpr std::chrono::seconds kAsk(2);
/// Questions that may fail in a row: a controller that restarts is back within a minute.
constexpr int kMostFailures = 60;
constexpr uint64_t kMaxLogBytes = uint64_t{1} << 20;

core::Result<io::ProcessResult>
runSlurm(const std::string& name, const std::vector<std::string>& words) {
    const auto program = io::findProgram(name);
    if (!program)
        return makeError("--slurm needs Slurm's program {}, which is not on PATH", name);
    return io::runProcess(*program, words, ".");
}

/// For a shell.
std::string quote(const std::string& word) {
    std::string quoted = "'";
    for (const char c : word)
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

/// A name that sbatch takes as it is: it replaces what follows a '%'.
std::string escapeName(const std::string& name) {
    std::string escaped;
    for (const char c : name)
        escaped += c == '%' ? std::string("%%") : std::string(1, c);
    return escaped;
}

void addTyped(std::vector<std::string>& words, const std::vector<std::string>& typed) {
    for (const std::string& option : typed)
        words.push_back(option.starts_with('-') ? option : "--" + option);
}

/// The id that sbatch tells: up to the name of a cluster.
core::Result<std::string> submit(const std::vector<std::string>& words) {
    const auto run = runSlurm("sbatch", words);
    if (!run)
        return run.error();
    if (run.value().exitStatus != 0)
        return makeError(
            "sbatch ended with status {}: {}",
            run.value().exitStatus,
            findLastSentence(run.value().errors)
        );
    const std::string said = findLastSentence(run.value().output);
    std::string id = said.substr(0, said.find(';'));
    if (id.empty() || id.find_first_not_of("0123456789") != std::string::npos)
        return makeError("sbatch said '{}' and no job's id", said);
    return id;
}

/// What sbatch is told of both jobs.
std::vector<std::string> listCommonWords(const PartWork& work) {
    return {
        "--parsable",
        "--job-name=" + work.name,
        "--chdir=" + work.start.string(),
        "--requeue",
        "--open-mode=append"};
}

std::vector<std::string> listPartWords(
    const PartWork& work,
    const std::string& program,
    const std::vector<uint32_t>& parts,
    const JobOptions& options
) {
    std::vector<std::string> words = listCommonWords(work);
    words.push_back("--array=" + formatTasks(parts));
    words.push_back("--output=" + escapeName(work.folder.string()) + "/part_%a.log");
    addTyped(words, options.sbatch);
    addTyped(words, options.sbatchPart);
    words.push_back(fmt::format(
        "--wrap=exec {} {} {} \"$SLURM_ARRAY_TASK_ID\"",
        quote(program),
        work.partCommand,
        quote(work.folder.string())
    ));
    return words;
}

/// \param parts id of the array that comes first; empty: none
std::vector<std::string> listFinishWords(
    const PartWork& work,
    const std::string& program,
    const std::string& parts,
    const JobOptions& options
) {
    std::vector<std::string> words = listCommonWords(work);
    words.push_back("--output=" + escapeName(finishLog(work.folder).string()));
    if (!parts.empty()) // without the second option it would wait for ever where a part failed
        words.insert(words.end(), {"--dependency=afterok:" + parts, "--kill-on-invalid-dep=yes"});
    addTyped(words, options.sbatch);
    words.push_back(fmt::format(
        "--wrap=exec {} {} {}", quote(program), work.finishCommand, quote(work.folder.string())
    ));
    return words;
}

/// What scancel says would hide the error before it.
void cancel(const SlurmJobs& jobs) {
    std::vector<std::string> submitted;
    for (const std::string& job : {jobs.parts, jobs.finish})
        if (!job.empty())
            submitted.push_back(job);
    if (!submitted.empty())
        (void)runSlurm("scancel", submitted);
}

core::Status writeJobs(const PartWork& work, const SlurmJobs& jobs) {
    nlohmann::ordered_json root;
    root["parts"] = jobs.parts;
    root["finish"] = jobs.finish;
    return json::writeJsonFile(jobsFile(work.folder), root);
}

core::Result<SlurmJobs> readJobs(const fs::path& file) {
    return json::readJsonFile(file, [](const json::JsonNode& root) {
        const auto object = root.readObject({"parts", "finish"});
        return SlurmJobs{
            object.require("parts").readString(), object.require("finish").readString()};
    });
}

/// Whether squeue lists any of the jobs.
core::Result<bool> areQueued(const SlurmJobs& jobs) {
    const std::string ids = jobs.parts.empty() ? jobs.finish : jobs.parts + "," + jobs.finish;
    const auto run = runSlurm("squeue", {"--noheader", "--format=%i", "--jobs=" + ids});
    if (!run)
        return run.error();
    if (run.value().exitStatus == 0)
        return !findLastSentence(run.value().output).empty();
    // Slurm forgets jobs some minutes after their end.
    if (run.value().errors.find("Invalid job id") != std::string::npos)
        return false;
    return makeError(
        "squeue ended with status {}: {}",
        run.value().exitStatus,
        findLastSentence(run.value().errors)
    );
}

/// The last line of a log; empty where there is none.
std::string readLastSentence(const fs::path& log) {
    std::error_code ignored;
    if (!fs::exists(log, ignored))
        return {};
    const auto bytes = io::readFileBytes(log, kMaxLogBytes);
    if (!bytes)
        return {};
    return findLastSentence(
        {reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size()}
    );
}

core::Error describeUnfinished(const PartWork& work) {
    const auto unfinished = work.listUnfinished();
    if (!unfinished)
        return unfinished.error();
    std::string who = "the job that finishes it";
    fs::path log = finishLog(work.folder);
    if (!unfinished.value().empty()) {
        const uint32_t part = unfinished.value().front();
        who = fmt::format("part {}", part);
        log = partLog(work.folder, part);
    }
    const std::string said = readLastSentence(log);
    return makeError(
        "the {} is not finished: {} {}; the same command goes on where it stopped",
        work.noun,
        who,
        said.empty() ? "was ended and said nothing" : "says: " + said
    );
}

/// Submits the parts and the job that finishes, and records their ids in the working folder.
/// Error: sbatch's own words; then nothing stays submitted.
core::Result<SlurmJobs>
submitWork(const PartWork& work, const std::vector<uint32_t>& parts, const JobOptions& options) {
    std::error_code failure;
    const std::string program = fs::read_symlink("/proc/self/exe", failure).string();
    if (failure)
        return makeError("cannot tell where this program lies: {}", failure.message());
    SlurmJobs jobs;
    if (!parts.empty()) {
        auto id = submit(listPartWords(work, program, parts, options));
        if (!id)
            return id.error();
        jobs.parts = id.value();
    }
    auto id = submit(listFinishWords(work, program, jobs.parts, options));
    if (!id) {
        cancel(jobs);
        return id.error();
    }
    jobs.finish = id.value();
    if (core::Status recorded = writeJobs(work, jobs); !recorded) {
        cancel(jobs);
        return recorded.error();
    }
    return jobs;
}

/// The work's jobs that were submitted before and are in the queue still, if any.
/// Error: squeue's own words, or the record is damaged.
core::Result<std::optional<SlurmJobs>> findQueuedJobs(const PartWork& work) {
    std::error_code ignored;
    const fs::path file = jobsFile(work.folder);
    if (!fs::exists(file, ignored))
        return std::optional<SlurmJobs>();
    const auto jobs = readJobs(file);
    if (!jobs)
        return jobs.error();
    const auto queued = areQueued(jobs.value());
    if (!queued)
        return queued.error();
    return queued.value() ? std::optional<SlurmJobs>(jobs.value()) : std::optional<SlurmJobs>();
}

/// Waits until the jobs have left the queue, with a bar of their progress on stderr.
/// Error: the work is not finished then; says what the first part that is not complete said last.
core::Status followJobs(const PartWork& work, const SlurmJobs& jobs) {
    PartProgress progress(work);
    int failures = 0;
    while (true) {
        const auto queued = areQueued(jobs);
        if (queued && !queued.value())
            break;
        failures = queued ? 0 : failures + 1;
        if (failures > kMostFailures)
            return queued.error();
        std::this_thread::sleep_for(kAsk);
        progress.look();
    }
    return work.isFinished() ? core::Status() : core::Status(describeUnfinished(work));
}

} // namespace

std::string formatTasks(std::span<const uint32_t> tasks) {
    std::string text;
    for (size_t i = 0; i < tasks.size();) {
        size_t last = i;
        while (last + 1 < tasks.size() && tasks[last + 1] == tasks[last] + 1)
            ++last;
        text += fmt::format("{}{}", text.empty() ? "" : ",", tasks[i]);
        if (last > i)
            text += fmt::format("-{}", tasks[last]);
        i = last + 1;
    }
    return text;
}

core::Status runBySlurm(const PartWork& work, const JobOptions& options) {
    auto queued = findQueuedJobs(work);
    if (!queued)
        return queued.error();
    SlurmJobs jobs;
    if (queued.value()) {
        jobs = *queued.value();
        fmt::print("the jobs {} {} draw this {} already\n", jobs.parts, jobs.finish, work.noun);
    } else {
        const auto parts = work.listUnfinished();
        if (!parts)
            return parts.error();
        auto submitted = submitWork(work, parts.value(), options);
        if (!submitted)
            return submitted.error();
        jobs = std::move(submitted).value();
        if (!jobs.parts.empty())
            fmt::print("job {}: parts {}\n", jobs.parts, formatTasks(parts.value()));
        fmt::print("job {}: finishes the {}\n", jobs.finish, work.noun);
    }
    std::fflush(stdout); // whoever waits knows what to wait for
    return options.wait ? followJobs(work, jobs) : core::Status();
}

} // namespace shutter::parts
