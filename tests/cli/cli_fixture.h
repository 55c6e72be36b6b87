// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <sys/types.h>
#include <vector>

namespace shutter::cli {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;

struct Outcome {
    int status = -1; ///< exit status, or 128 + signal
    std::string out;
    std::string err;
};

// Exit statuses of the program.
inline constexpr int kFailed = 1;
inline constexpr int kUsage = 2;
inline constexpr int kKilled = 128 + 9; ///< by SIGKILL

struct Refusal {
    Arguments arguments;
    int status = kUsage;
    Arguments mentions;
};

/// Each test has a separate folder, in which the program runs and all of whose files are known.
class Cli : public testing::Test {
  protected:
    Cli();
    ~Cli() override;

    [[nodiscard]] Outcome run(const Arguments& arguments) const;

    /// Starts the program and returns at once; the caller must wait for it.
    [[nodiscard]] pid_t start(const Arguments& arguments) const;

    /// Waits for the process that start() started last.
    [[nodiscard]] Outcome finish(pid_t process) const;

    /// Sends a signal to that process and waits for it.
    [[nodiscard]] Outcome stop(pid_t process, int signal) const;

    [[nodiscard]] static Arguments join(Arguments first, const Arguments& second);

    /// `render` of the vase at 64x36 on lavapipe, by `sharp` if `more` names no method.
    [[nodiscard]] Arguments renderVase(const Arguments& more) const;

    /// Runs and expects `status`, one line "shutter: ..." on stderr with all of `mentions`, nothing
    /// on stdout, and no file that was not there before.
    void expectRefusal(const Arguments& arguments, int status, const Arguments& mentions) const;

    void expectRefusals(const std::vector<Refusal>& refusals) const;

    /// Runs and expects exit status 0 and nothing on stderr but progress.
    Outcome expectSuccess(const Arguments& arguments) const;

    /// The same, and all of `parts` on stdout. \return stdout
    std::string expectPrinted(const Arguments& arguments, const Arguments& parts) const;

    /// Runs and expects exit status 0 and `part` on stderr.
    void expectWarned(const Arguments& arguments, const std::string& part) const;

    /// Runs and expects exit status 1 and `part` on stderr; files may have been written.
    void expectFailure(const Arguments& arguments, const std::string& part) const;

    [[nodiscard]] std::string path(const std::string& name) const { return mFolder / name; }

    void writeFile(const std::string& name, const std::string& content) const;
    [[nodiscard]] std::string readFile(const std::string& name) const;
    [[nodiscard]] std::set<std::string> listFiles() const;

    /// Skips the test where there is no lavapipe to draw on.
    void requireDevice() const;

    /// From now on a copy of the program is run that lies alone in a folder.
    void isolateProgram();

    /// From now on the program is held to the permissions of files even if root runs it. Skips the
    /// test where root may not give up its capabilities.
    void requirePermissions();

    /// From now on only `compare` is run, in this process: it draws nothing, and takes less time
    /// than the program takes to start.
    void compareHere() { mComparesHere = true; }

  private:
    [[nodiscard]] Outcome compare(const Arguments& arguments) const;

    bool mComparesHere = false;
    Arguments mProgram = {SHUTTER_EXECUTABLE}; ///< the program, after what starts it
    fs::path mFolder;
    fs::path mLogs; ///< what the program prints
};

/// Names lavapipe.
inline const Arguments kOnSoftware = {"--device", "llvmpipe"};

} // namespace shutter::cli
