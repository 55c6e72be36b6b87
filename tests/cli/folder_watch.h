// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstring>
#include <poll.h>
#include <string>
#include <sys/inotify.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace shutter::cli {

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

} // namespace shutter::cli
