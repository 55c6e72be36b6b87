// SPDX-License-Identifier: MIT
// Killed in the middle of a sequence: what lies under a picture's name is a whole picture.
#include "engine/image/image.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

#include <array>
#include <csignal>
#include <cstring>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace shutter::cli {

namespace {

/// Waits for files to appear in a folder; neither sleeps nor reads the clock.
class FolderWatch {
  public:
    explicit FolderWatch(const std::string& folder) : mNotify(inotify_init1(IN_CLOEXEC)) {
        inotify_add_watch(mNotify, folder.c_str(), IN_CREATE | IN_MOVED_TO);
    }

    ~FolderWatch() { close(mNotify); }

    FolderWatch(const FolderWatch&) = delete;
    FolderWatch& operator=(const FolderWatch&) = delete;

    /// Returns once `count` files were created or renamed, or the process ended.
    void waitFor(int count, pid_t process) const {
        const int ended = static_cast<int>(syscall(SYS_pidfd_open, process, 0));
        std::array<pollfd, 2> waited{{{mNotify, POLLIN, 0}, {ended, POLLIN, 0}}};
        while (count > 0 && poll(waited.data(), waited.size(), -1) > 0) {
            if (waited[1].revents != 0)
                break;
            count -= readEvents();
        }
        close(ended);
    }

  private:
    int readEvents() const {
        alignas(inotify_event) std::array<char, 4096> buffer{};
        const ssize_t bytes = read(mNotify, buffer.data(), buffer.size());
        int count = 0;
        for (ssize_t at = 0; at < bytes; ++count) {
            inotify_event event{};
            std::memcpy(&event, buffer.data() + at, sizeof(event));
            at += ssize_t(sizeof(event)) + ssize_t(event.len);
        }
        return count;
    }

    int mNotify;
};

} // namespace

TEST_F(Cli, AnInterruptedSequenceLeavesNoHalfPicture) {
    requireDevice();
    if (IsSkipped())
        return;
    // Each picture is two events, its temporary file and the rename: an odd number falls between
    // them, an even one before the next picture.
    for (const int events : {5, 6, 7, 9}) {
        const std::string folder = path(std::to_string(events));
        fs::create_directory(folder);
        const FolderWatch watch(folder);
        const pid_t process = start(renderVase(
            {"--method", "sharp", "--frames", "0:99999", "--out", folder + "/f_%06d.exr"}
        ));
        watch.waitFor(events, process);
        kill(process, SIGKILL);
        int status = 0;
        waitpid(process, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself";
        int pictures = 0;
        for (const auto& entry : fs::directory_iterator(folder)) {
            if (entry.path().extension() != ".exr")
                continue;
            const auto picture = io::readImage(entry.path());
            ASSERT_TRUE(picture.ok()) << picture.error().message;
            EXPECT_EQ(picture.value().width, 64u);
            EXPECT_EQ(picture.value().height, 36u);
            ++pictures;
        }
        EXPECT_GE(pictures, events / 2);
    }
}

} // namespace shutter::cli
