// SPDX-License-Identifier: MIT
#include "engine/io/process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <string_view>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace shutter::io {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMaxOutputBytes = size_t{1} << 20;
constexpr size_t kMaxErrorBytes = size_t{64} << 10;

/// Both ends close when it goes.
class Pipe {
  public:
    Pipe() {
        mOpened = ::pipe2(mEnds.data(), O_CLOEXEC) == 0;
        // Where a standard stream is closed an end may have taken its place, which the child needs.
        for (int& end : mEnds)
            if (mOpened && end <= STDERR_FILENO) {
                const int low =
                    std::exchange(end, ::fcntl(end, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
                ::close(low);
                mOpened = end >= 0;
            }
    }

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

/// Arguments and descriptors with which a child becomes the program.
struct Child {
    const char* program;
    char* const* arguments;
    const char* folder;
    int output;
    int errors;
    int failure; ///< where it writes the errno that kept it from becoming the program
    pid_t parent;
};

/// Runs in the copy of a program with threads: calls nothing but the system.
[[noreturn]] void become(const Child& child) {
    // The child ends with us, even by SIGKILL, since its output would have no reader.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != child.parent)
        ::_exit(127); // we ended before the call above
    const int nothing = ::open("/dev/null", O_RDONLY);
    if (nothing >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 &&
        ::dup2(child.output, STDOUT_FILENO) >= 0 && ::dup2(child.errors, STDERR_FILENO) >= 0 &&
        ::chdir(child.folder) == 0) {
        if (nothing > STDERR_FILENO)
            ::close(nothing);
        ::execv(child.program, child.arguments);
    }
    const int why = errno;
    // Who would read it is there, or has ended us.
    [[maybe_unused]] const ssize_t written = ::write(child.failure, &why, sizeof(why));
    ::_exit(127);
}

/// The errno that the child wrote; 0 once it is the program.
int readFailure(Pipe& failure) {
    failure.closeEnd(1);
    int why = 0;
    while (::read(failure.reading(), &why, sizeof(why)) < 0 && errno == EINTR) {
    }
    return why;
}

/// Reads both until their ends.
void collect(Pipe& output, Pipe& errors, ProcessResult& result) {
    std::array<pollfd, 2> waited{{{output.reading(), POLLIN, 0}, {errors.reading(), POLLIN, 0}}};
    const std::array<std::string*, 2> texts{&result.output, &result.errors};
    while (waited[0].fd >= 0 || waited[1].fd >= 0) {
        if (::poll(waited.data(), waited.size(), -1) < 0) {
            if (errno == EINTR)
                continue; // `revents` is stale after an interrupted call
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
    Pipe failed;
    if (!output.isOpen() || !errors.isOpen() || !failed.isOpen())
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
    const Child child{
        absolute.c_str(),
        argv.data(),
        folder.c_str(),
        output.writing(),
        errors.writing(),
        failed.writing(),
        ::getpid()};
    const pid_t process = ::fork();
    if (process < 0)
        return failure(errno);
    if (process == 0)
        become(child);
    if (const int why = readFailure(failed); why != 0) {
        waitFor(process);
        return failure(why);
    }
    output.closeEnd(1);
    errors.closeEnd(1);
    ProcessResult result;
    collect(output, errors, result);
    result.exitStatus = waitFor(process);
    return result;
}

} // namespace shutter::io
