// SPDX-License-Identifier: MIT
#include "engine/core/progress.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <stdlib.h>
#include <string>
#include <unistd.h>

namespace shutter::core {
namespace {

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

    /// What was written since the last call.
    std::string takeOutput() {
        char buffer[1024];
        const ssize_t size = read(mMaster, buffer, sizeof buffer);
        return size > 0 ? std::string(buffer, static_cast<size_t>(size)) : std::string();
    }

  private:
    int mMaster;
    FILE* mSlave = nullptr;
};

TEST(FormatProgress, DrawsTheShareDoneAndTheTimeLeft) {
    EXPECT_EQ(
        formatProgress("rendering", 5, 10, 3.0),
        "rendering [===============               ] 5/10  3 s left"
    );
    EXPECT_EQ(formatProgress("x", 1, 4, 2.0), "x [=======                       ] 1/4  6 s left");
}

TEST(FormatProgress, AtTheStartNoTimeIsKnownAndAtTheEndNoneIsLeft) {
    EXPECT_EQ(formatProgress("x", 0, 2, 9.0), "x [                              ] 0/2  ? s left");
    EXPECT_EQ(formatProgress("x", 2, 2, 9.0), "x [==============================] 2/2  0 s left");
}

TEST(Progress, IsSilentForTheFirstSecondAndThenDraws) {
    Terminal terminal;
    if (!terminal.file())
        GTEST_SKIP() << "no pseudo-terminal is to be had here";
    Progress progress("rendering", 4, terminal.file(), fakeClock);
    passSeconds(0.5);
    progress.advance();
    EXPECT_EQ(terminal.takeOutput(), "");
    passSeconds(0.75);
    progress.advance();
    EXPECT_EQ(terminal.takeOutput(), "\r\x1b[K" + formatProgress("rendering", 2, 4, 1.25));
}

TEST(Progress, RedrawsAtMostTenTimesASecondAndCleansUp) {
    Terminal terminal;
    if (!terminal.file())
        GTEST_SKIP() << "no pseudo-terminal is to be had here";
    {
        Progress progress("x", 3, terminal.file(), fakeClock);
        passSeconds(2.0);
        progress.advance();
        EXPECT_NE(terminal.takeOutput(), "");
        passSeconds(0.05);
        progress.advance();
        EXPECT_EQ(terminal.takeOutput(), "");
    }
    EXPECT_EQ(terminal.takeOutput(), "\r\x1b[K");
}

TEST(Progress, IsSilentWhereTheOutputIsNoTerminal) {
    FILE* file = tmpfile();
    ASSERT_NE(file, nullptr);
    {
        Progress progress("x", 2, file, fakeClock);
        passSeconds(10.0);
        progress.advance();
    }
    EXPECT_EQ(ftell(file), 0);
    fclose(file);
}

TEST(Progress, MoreStepsThanAnnouncedStayAtTheEnd) {
    Terminal terminal;
    if (!terminal.file())
        GTEST_SKIP() << "no pseudo-terminal is to be had here";
    Progress progress("x", 0, terminal.file(), fakeClock);
    passSeconds(2.0);
    progress.advance();
    (void)terminal.takeOutput();
    passSeconds(2.0);
    progress.advance();
    EXPECT_EQ(terminal.takeOutput(), "\r\x1b[K" + formatProgress("x", 1, 1, 4.0));
}

} // namespace
} // namespace shutter::core
