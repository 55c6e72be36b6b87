// SPDX-License-Identifier: MIT
#include "engine/io/process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

extern char** environ;

namespace shutter::io {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxOutputBytes = size_t{1} << 20;
constexpr size_t kMaxErrorBytes = size_t{64} << 10;

/// Both ends close when it goes.
class Pipe {
  public:
    Pipe() { mOpened = ::pipe2(mEnds.data(), O_CLOEXEC) == 0; }

    ~Pipe() {
        closeEnd(0);
        closeEnd(1);
    }

    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    [[nodiscard]] bool isOpen() const { return mOpened; }

    [[nodiscard]] int reading() const { return mEnds[0]; }

    [[nodiscard]] int writing() const { return mEnds[1]; }

    void closeEnd(size_t which) {
        if (mEnds[which] >= 0)
            ::close(mEnds[which]);
        mEnds[which] = -1;
    }

  private:
    std::array<int, 2> mEnds{-1, -1};
    bool mOpened = false;
};

/// What the child does before it becomes the program.
class SpawnActions {
  public:
    SpawnActions() { posix_spawn_file_actions_init(&mActions); }

    ~SpawnActions() { posix_spawn_file_actions_destroy(&mActions); }

    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;

    [[nodiscard]] posix_spawn_file_actions_t* get() { return &mActions; }

  private:
    posix_spawn_file_actions_t mActions{};
};

/// Reads both until their ends.
void collect(Pipe& output, Pipe& errors, ProcessResult& result) {
    std::array<pollfd, 2> waited{{{output.reading(), POLLIN, 0}, {errors.reading(), POLLIN, 0}}};
    const std::array<std::string*, 2> texts{&result.output, &result.errors};
    while (waited[0].fd >= 0 || waited[1].fd >= 0) {
        if (::poll(waited.data(), waited.size(), -1) < 0) {
            if (errno == EINTR)
                continue; // what stands in `revents` is of the round before
            break;
        }
        for (size_t i = 0; i < waited.size(); ++i) {
            if (waited[i].fd < 0 || waited[i].revents == 0)
                continue;
            std::array<char, 4096> buffer{};
            const ssize_t bytes = ::read(waited[i].fd, buffer.data(), buffer.size());
            if (bytes > 0)
                texts[i]->append(buffer.data(), size_t(bytes));
            else if (bytes == 0 || errno != EINTR)
                waited[i].fd = -1; // poll passes over it
        }
        if (result.output.size() > kMaxOutputBytes)
            result.output.resize(kMaxOutputBytes);
        if (result.errors.size() > kMaxErrorBytes)
            result.errors.erase(0, result.errors.size() - kMaxErrorBytes);
    }
}

int waitFor(pid_t process) {
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

} // namespace

std::optional<fs::path> findProgram(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::string_view rest = path ? path : "";
    while (!rest.empty()) {
        const size_t end = std::min(rest.find(':'), rest.size());
        const fs::path program = fs::path(rest.substr(0, end)) / name;
        std::error_code ignored;
        if (end > 0 && fs::is_regular_file(program, ignored) &&
            ::access(program.c_str(), X_OK) == 0)
            return program;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return std::nullopt;
}

core::Result<ProcessResult> runProcess(
    const fs::path& program, const std::vector<std::string>& arguments, const fs::path& folder
) {
    const auto failure = [&](int why) {
        return core::makeError(
            "cannot run '{}': {}", program.string(), std::generic_category().message(why)
        );
    };
    Pipe output;
    Pipe errors;
    if (!output.isOpen() || !errors.isOpen())
        return failure(errno);
    // The program's own path may be relative to where we are, not to where it will run.
    std::error_code ignored;
    const fs::path absolute = fs::absolute(program, ignored);
    std::vector<std::string> words = {program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    SpawnActions actions;
    posix_spawn_file_actions_addopen(actions.get(), STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(actions.get(), output.writing(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(actions.get(), errors.writing(), STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(actions.get(), folder.c_str());
    pid_t process = 0;
    const int failed =
        ::posix_spawn(&process, absolute.c_str(), actions.get(), nullptr, argv.data(), environ);
    if (failed != 0)
        return failure(failed);
    output.closeEnd(1);
    errors.closeEnd(1);
    ProcessResult result;
    collect(output, errors, result);
    result.exitStatus = waitFor(process);
    return result;
}

} // namespace shutter::io
