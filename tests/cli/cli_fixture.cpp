// SPDX-License-Identifier: MIT
#include "tests/cli/cli_fixture.h"

#include "game/cli/commands.h"
#include "game/options/program.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <regex>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace shutter::cli {

namespace {

std::string readAll(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void redirect(const fs::path& path, int descriptor) {
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, descriptor);
    close(file);
}

/// What the programs of all tests keep for one another: pipelines are compiled once.
const fs::path& findCaches() {
    static const struct Folder {
        fs::path path = fs::temp_directory_path() / fmt::format("shutter_cli_{}_caches", getpid());

        ~Folder() {
            std::error_code ignored;
            fs::remove_all(path, ignored);
        }
    } caches;

    return caches.path;
}

/// Null at the end. The words must outlive it.
std::vector<char*> pointTo(Arguments& words) {
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    return argv;
}

/// The program, of which `compare` is the only command, in this process.
int runComparison(Arguments words) {
    words.insert(words.begin(), "shutter");
    std::vector<char*> argv = pointTo(words);
    CLI::App app("", "shutter");
    app.require_subcommand(1);
    int exitStatus = game::kExitDone;
    game::addCompareCommand(app, exitStatus);
    return game::runProgram(app, static_cast<int>(words.size()), argv.data(), exitStatus);
}

} // namespace

Cli::Cli() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    const fs::path base =
        fs::temp_directory_path() / fmt::format("shutter_cli_{}_{}", getpid(), info->name());
    mFolder = base / "files";
    mLogs = base / "logs";
    fs::create_directories(mFolder);
    fs::create_directories(mLogs);
}

Cli::~Cli() {
    std::error_code ignored;
    fs::remove_all(mFolder.parent_path(), ignored);
}

pid_t Cli::start(const Arguments& arguments) const {
    Arguments words = mProgram;
    words.insert(words.end(), arguments.begin(), arguments.end());
    const std::vector<char*> argv = pointTo(words);
    findCaches();
    const pid_t child = fork();
    if (child != 0)
        return child;
    redirect(mLogs / "out", STDOUT_FILENO);
    redirect(mLogs / "err", STDERR_FILENO);
    setenv("XDG_CACHE_HOME", findCaches().c_str(), 1);
    if (chdir(mFolder.c_str()) == 0)
        execvp(argv[0], argv.data());
    _exit(127);
}

Outcome Cli::run(const Arguments& arguments) const {
    return mComparesHere ? compare(arguments) : finish(start(arguments));
}

Outcome Cli::compare(const Arguments& arguments) const {
    const fs::path before = fs::current_path();
    std::fflush(stdout);
    const std::array own = {dup(STDOUT_FILENO), dup(STDERR_FILENO)};
    redirect(mLogs / "out", STDOUT_FILENO);
    redirect(mLogs / "err", STDERR_FILENO);
    fs::current_path(mFolder);
    const int status = runComparison(arguments);
    fs::current_path(before);
    std::fflush(stdout);
    dup2(own[0], STDOUT_FILENO);
    dup2(own[1], STDERR_FILENO);
    for (const int descriptor : own)
        close(descriptor);
    return {status, readAll(mLogs / "out"), readAll(mLogs / "err")};
}

Outcome Cli::stop(pid_t process, int signal) const {
    kill(process, signal);
    return finish(process);
}

Outcome Cli::finish(pid_t process) const {
    int status = 0;
    waitpid(process, &status, 0);
    Outcome outcome;
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = readAll(mLogs / "out");
    outcome.err = readAll(mLogs / "err");
    return outcome;
}

Arguments Cli::renderVase(const Arguments& more) const {
    Arguments arguments = {"render", SHUTTER_ASSETS "/vase.glb", "--size", "64x36"};
    if (std::find(more.begin(), more.end(), "--method") == more.end())
        arguments.insert(arguments.end(), {"--method", "sharp"});
    arguments.insert(arguments.end(), kOnSoftware.begin(), kOnSoftware.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

Arguments Cli::join(Arguments first, const Arguments& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

void Cli::expectRefusals(const std::vector<Refusal>& refusals) const {
    for (const Refusal& refusal : refusals)
        expectRefusal(refusal.arguments, refusal.status, refusal.mentions);
}

void Cli::expectRefusal(const Arguments& arguments, int status, const Arguments& mentions) const {
    const std::set<std::string> before = listFiles();
    const Outcome outcome = run(arguments);
    const std::string shown = fmt::format("{}\n{}", fmt::join(arguments, " "), outcome.err);
    EXPECT_EQ(outcome.status, status) << shown;
    EXPECT_EQ(outcome.out, "") << shown;
    EXPECT_TRUE(outcome.err.starts_with("shutter: ")) << shown;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << shown;
    EXPECT_TRUE(outcome.err.ends_with("\n")) << shown;
    for (const std::string& mention : mentions)
        EXPECT_NE(outcome.err.find(mention), std::string::npos) << mention << "\n" << shown;
    EXPECT_EQ(listFiles(), before) << shown;
}

Outcome Cli::expectSuccess(const Arguments& arguments) const {
    const Outcome outcome = run(arguments);
    const std::string shown = fmt::format("{}", fmt::join(arguments, " "));
    EXPECT_EQ(outcome.status, 0) << shown << "\n" << outcome.err;
    // A busy machine may take long enough for lines of progress.
    static const std::regex kProgress("shutter: rendering: [^\n]*\n");
    EXPECT_EQ(std::regex_replace(outcome.err, kProgress, ""), "") << shown;
    return outcome;
}

std::string Cli::expectPrinted(const Arguments& arguments, const Arguments& parts) const {
    std::string out = expectSuccess(arguments).out;
    for (const std::string& part : parts)
        EXPECT_NE(out.find(part), std::string::npos) << part << "\n" << out;
    return out;
}

void Cli::expectWarned(const Arguments& arguments, const std::string& part) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
}

void Cli::expectFailure(const Arguments& arguments, const std::string& part) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, kFailed);
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
}

void Cli::writeFile(const std::string& name, const std::string& content) const {
    std::ofstream(mFolder / name, std::ios::binary) << content;
}

std::string Cli::readFile(const std::string& name) const {
    return readAll(mFolder / name);
}

std::set<std::string> Cli::listFiles() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(mFolder))
        names.insert(entry.path().lexically_relative(mFolder).string()); // links may lead nowhere
    return names;
}

void Cli::requireDevice() const {
    static const bool isThere =
        run({"info", "--devices"}).out.find("llvmpipe") != std::string::npos;
    if (!isThere)
        GTEST_SKIP() << "lavapipe is not installed";
}

void Cli::isolateProgram() {
    const fs::path copy = mFolder.parent_path() / "alone" / "shutter";
    fs::create_directory(copy.parent_path());
    fs::copy_file(mProgram.back(), copy);
    mProgram.back() = copy;
}

void Cli::requirePermissions() {
    if (geteuid() != 0)
        return;
    // Root bypasses permissions by a capability, not by its user id.
    const Arguments held = {"setpriv", "--bounding-set=-dac_override,-dac_read_search"};
    const Arguments program = std::exchange(mProgram, held);
    const bool canHold = run({"true"}).status == 0;
    mProgram.insert(mProgram.end(), program.begin(), program.end());
    if (!canHold)
        GTEST_SKIP() << "root may write everywhere, and setpriv cannot take that from it";
}

} // namespace shutter::cli
