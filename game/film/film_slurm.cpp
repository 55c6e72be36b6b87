// SPDX-License-Identifier: MIT
#include "game/film/film_slurm.h"

#include "engine/io/file_bytes.h"
#include "engine/io/process.h"
#include "engine/json/json_file.h"
#include "game/film/film_part.h"
#include "game/film/film_progress.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <system_error>
#include <thread>

namespace shutter::film {

namespace fs = std::filesystem;

using core::makeError;

namespace {

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
std::vector<std::string> listCommonWords(const Film& film) {
    const game::OutputOptions& output = film.options.output;
    const fs::path& name = output.film.empty() ? output.out : output.film;
    return {
        "--parsable",
        "--job-name=" + name.filename().string(),
        "--chdir=" + film.plan.folder.string(),
        "--requeue",
        "--open-mode=append"};
}

std::vector<std::string> listPartWords(
    const Film& film,
    const std::string& program,
    const std::vector<uint32_t>& parts,
    const SlurmOptions& options
) {
    std::vector<std::string> words = listCommonWords(film);
    words.push_back("--array=" + formatTasks(parts));
    words.push_back("--output=" + escapeName(film.work.string()) + "/part_%a.log");
    addTyped(words, options.all);
    addTyped(words, options.parts);
    words.push_back(fmt::format(
        "--wrap=exec {} film-part {} \"$SLURM_ARRAY_TASK_ID\"",
        quote(program),
        quote(film.work.string())
    ));
    return words;
}

/// \param parts id of the array that comes first; empty: none
std::vector<std::string> listFinishWords(
    const Film& film,
    const std::string& program,
    const std::string& parts,
    const SlurmOptions& options
) {
    std::vector<std::string> words = listCommonWords(film);
    words.push_back("--output=" + escapeName(finishLog(film.work).string()));
    if (!parts.empty()) // without the second option it would wait for ever where a part failed
        words.insert(words.end(), {"--dependency=afterok:" + parts, "--kill-on-invalid-dep=yes"});
    addTyped(words, options.all);
    words.push_back(
        fmt::format("--wrap=exec {} film-finish {}", quote(program), quote(film.work.string()))
    );
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

core::Status writeJobs(const Film& film, const SlurmJobs& jobs) {
    nlohmann::ordered_json root;
    root["parts"] = jobs.parts;
    root["finish"] = jobs.finish;
    return json::writeJsonFile(jobsFile(film.work), root);
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

core::Error describeUnfinished(const Film& film) {
    const auto unfinished = listUnfinishedParts(film);
    if (!unfinished)
        return unfinished.error();
    std::string who = "the job that finishes it";
    fs::path log = finishLog(film.work);
    if (!unfinished.value().empty()) {
        who = fmt::format("part {}", unfinished.value().front().part);
        log = partLog(film.work, unfinished.value().front().part);
    }
    const std::string said = readLastSentence(log);
    return makeError(
        "the film is not finished: {} {}; the same command goes on where it stopped",
        who,
        said.empty() ? "was ended and said nothing" : "says: " + said
    );
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

core::Result<SlurmJobs>
submitFilm(const Film& film, const std::vector<uint32_t>& parts, const SlurmOptions& options) {
    std::error_code failure;
    const std::string program = fs::read_symlink("/proc/self/exe", failure).string();
    if (failure)
        return makeError("cannot tell where this program lies: {}", failure.message());
    SlurmJobs jobs;
    if (!parts.empty()) {
        auto id = submit(listPartWords(film, program, parts, options));
        if (!id)
            return id.error();
        jobs.parts = id.value();
    }
    auto id = submit(listFinishWords(film, program, jobs.parts, options));
    if (!id) {
        cancel(jobs);
        return id.error();
    }
    jobs.finish = id.value();
    if (core::Status recorded = writeJobs(film, jobs); !recorded) {
        cancel(jobs);
        return recorded.error();
    }
    return jobs;
}

core::Result<std::optional<SlurmJobs>> findQueuedJobs(const Film& film) {
    std::error_code ignored;
    const fs::path file = jobsFile(film.work);
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

core::Status followJobs(const Film& film, const SlurmJobs& jobs) {
    FrameProgress progress(film);
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
    // A sequence of pictures has no film to look for: the job that finishes it removes the plan.
    std::error_code ignored;
    const bool isFinished = film.options.output.film.empty()
                                ? !fs::exists(planFile(film.work), ignored)
                                : isFilmFinished(film);
    return isFinished ? core::Status() : core::Status(describeUnfinished(film));
}

} // namespace shutter::film
