// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sys/types.h>
#include <vector>

namespace shutter::cli {

/// The processes that a process has started, and that run.
inline std::vector<pid_t> listChildren(pid_t process) {
    std::vector<pid_t> children;
    for (const auto& thread :
         std::filesystem::directory_iterator(fmt::format("/proc/{}/task", process))) {
        std::ifstream list(thread.path() / "children");
        for (pid_t child = 0; list >> child;)
            children.push_back(child);
    }
    return children;
}

} // namespace shutter::cli
