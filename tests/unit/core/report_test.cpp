// SPDX-License-Identifier: MIT
// Checks, results, logs, progress and jobs.
#include "engine/core/check.h"
#include "engine/core/log.h"
#include "engine/core/parallel_jobs.h"
#include "engine/core/progress.h"
#include "engine/core/result.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fcntl.h>
#include <stdlib.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace shutter::core {
namespace {

TEST(Check, ATrueConditionPassesAndIsEvaluatedOnce) {
    int evaluations = 0;
    SHUTTER_CHECK(++evaluations == 1, "never printed");
    EXPECT_EQ(evaluations, 1);
    SHUTTER_CHECK_EQ(++evaluations, 2);
    EXPECT_EQ(evaluations, 2);
}

TEST(CheckDeathTest, AFailedCheckNamesItsConditionPlaceDetailAndValues) {
    const int count = 3;
    EXPECT_DEATH(
        SHUTTER_CHECK(count < 3, "count is {}", count),
        "report_test.cpp:[0-9]+: CHECK failed: count < 3 \\(count is 3\\)"
    );
    EXPECT_DEATH(SHUTTER_CHECK_EQ(count, 5), "count == 5 \\(3 and 5\\)");
}

TEST(ResultDeathTest, AResultHasTheErrorItWasMadeFromAndAccessToWhatItLacksAborts) {
    Result<int> failed = makeError("no such file");
    EXPECT_DEATH((void)failed.value(), "value\\(\\) of an error: no such file");
    EXPECT_DEATH((void)std::as_const(failed).value(), "no such file");
    EXPECT_DEATH((void)std::move(failed).value(), "no such file");
    EXPECT_DEATH((void)Result<int>(3).error(), "error\\(\\) of a result");
    EXPECT_DEATH((void)Status().error(), "error\\(\\) of a success");
    const Result<int> result = makeError("{}: field '{}' is missing", "a.gltf", "asset");
    EXPECT_FALSE(result.ok());
    EXPECT_FALSE(static_cast<bool>(result));
    EXPECT_EQ(result.error().message, "a.gltf: field 'asset' is missing");
}

TEST(Log, WarningsArePrintedAsTheyAreAndInfoOnRequest) {
    testing::internal::CaptureStderr();
    logInfo("device {}", 1);
    logWarning("mip {} is missing", 2);
    writeLog(LogLevel::Warning, "{\"json\": {}}");
    setLogLevel(LogLevel::Info);
    logInfo("device {}", 3);
    setLogLevel(LogLevel::Warning);
    EXPECT_EQ(
        testing::internal::GetCapturedStderr(),
        "shutter: warning: mip 2 is missing\nshutter: warning: {\"json\": {}}\nshutter: device 3\n"
    );
}

Progress::TimePoint gNow;

Progress::TimePoint fakeClock() {
    return gNow;
}

void passSeconds(double seconds) {
    gNow += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(seconds)
    );
}

/// A terminal to write to whose output can be read.
class Terminal {
  public:
    Terminal() : mMaster(posix_openpt(O_RDWR | O_NOCTTY)) {
        if (mMaster < 0 || grantpt(mMaster) != 0 || unlockpt(mMaster) != 0)
            return;
        mSlave = fopen(ptsname(mMaster), "w");
        fcntl(mMaster, F_SETFL, O_NONBLOCK);
    }

    ~Terminal() {
        if (mSlave)
            fclose(mSlave);
        if (mMaster >= 0)
            close(mMaster);
    }

    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    [[nodiscard]] FILE* file() const { return mSlave; }

    /// Output since the last call.
    std::string takeOutput() {
        char buffer[1024];
        const ssize_t size = read(mMaster, buffer, sizeof buffer);
        return size > 0 ? std::string(buffer, static_cast<size_t>(size)) : std::string();
    }

  private:
    int mMaster;
    FILE* mSlave = nullptr;
};

TEST(FormatProgress, TheBarShowsTheShareDoneAndTheTimeLeft) {
    EXPECT_EQ(
        formatProgress("rendering", 5, 10, 3.0),
        "rendering [===============               ] 5/10  3 s left"
    );
    EXPECT_EQ(formatProgress("x", 1, 4, 2.0), "x [=======                       ] 1/4  6 s left");
    EXPECT_EQ(formatProgress("x", 0, 2, 9.0), "x [                              ] 0/2  ? s left");
    EXPECT_EQ(formatProgress("x", 2, 2, 9.0), "x [==============================] 2/2  0 s left");
}

TEST(Progress, TheBarIsSilentForASecondThenDrawnAtMostTenTimesASecondAndCleanedUp) {
    Terminal terminal;
    if (!terminal.file())
        GTEST_SKIP() << "no pseudo-terminal is to be had here";
    const auto advance = [&](Progress& progress, double seconds) {
        passSeconds(seconds);
        progress.advance();
        return terminal.takeOutput();
    };
    {
        Progress progress("rendering", 4, terminal.file(), fakeClock);
        EXPECT_EQ(advance(progress, 0.5), "");
        EXPECT_EQ(advance(progress, 0.75), "\r\x1b[K" + formatProgress("rendering", 2, 4, 1.25));
        EXPECT_EQ(advance(progress, 0.05), "");
        progress.startPart("vase: gather");
    }
    EXPECT_EQ(terminal.takeOutput(), "\r\x1b[K") << "parts are no lines on a terminal";
    Progress more("x", 0, terminal.file(), fakeClock);
    (void)advance(more, 2.0);
    EXPECT_EQ(advance(more, 2.0), "\r\x1b[K" + formatProgress("x", 1, 1, 4.0))
        << "of more steps than announced the bar stays at its end";
}

/// What is written to a file, which is no terminal.
template <class Write> std::string collectLines(const Write& write) {
    std::FILE* file = std::tmpfile();
    if (!file)
        return "no file";
    write(file);
    std::rewind(file);
    std::string written(200, '\0');
    written.resize(std::fread(written.data(), 1, written.size(), file));
    std::fclose(file);
    return written;
}

TEST(Progress, OnlyPartsAreLinesWhereTheOutputIsNoTerminal) {
    const std::string written = collectLines([](std::FILE* file) {
        Progress progress("measuring", 3, file, fakeClock);
        progress.startPart("vase: gather");
        passSeconds(10.0);
        progress.advance(2);
        progress.startPart("vase: hybrid");
    });
    EXPECT_EQ(
        written,
        "shutter: measuring vase: gather; 0 % done\nshutter: measuring vase: hybrid; 66 % done\n"
    );
}

TEST(Progress, LinesWithTheTimeLeftComeEveryTenSecondsWhereTheyAreWantedAndThereIsNoTerminal) {
    const std::string written = collectLines([](std::FILE* file) {
        Progress progress("rendering", 4, file, fakeClock);
        progress.printLines();
        for (const double seconds : {9.0, 2.0, 8.0, 9.0}) {
            passSeconds(seconds);
            progress.advance();
        }
    });
    EXPECT_EQ(
        written,
        "shutter: rendering: 50 % done, 11 s left\nshutter: rendering: 100 % done, 0 s left\n"
    );
}

TEST(ParallelJobs, EachRunsOnce) {
    std::vector<std::atomic<int>> runs(100);
    runParallelJobs(runs.size(), [&](size_t i) { ++runs[i]; });
    for (const auto& count : runs)
        EXPECT_EQ(count, 1);
    runParallelJobs(0, [](size_t) { FAIL() << "there is none"; });
}

} // namespace
} // namespace shutter::core
