// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace shutter::cli {

/// Programs of Slurm, first on PATH, that record their arguments in the file `calls`.
class FakeSlurm {
  public:
    explicit FakeSlurm(std::filesystem::path folder) : mFolder(std::move(folder)) {
        const char* path = std::getenv("PATH"); // NOLINT(concurrency-mt-unsafe)
        mPath = path ? path : "";
        std::filesystem::create_directory(mFolder / "bin");
        setenv( // NOLINT(concurrency-mt-unsafe)
            "PATH",
            ((mFolder / "bin").string() + ":" + mPath).c_str(),
            1
        );
    }

    ~FakeSlurm() { setenv("PATH", mPath.c_str(), 1); } // NOLINT(concurrency-mt-unsafe)

    FakeSlurm(const FakeSlurm&) = delete;
    FakeSlurm& operator=(const FakeSlurm&) = delete;

    void writeProgram(const std::string& name, const std::string& body) const {
        const std::filesystem::path file = mFolder / "bin" / name;
        std::ofstream(file) << fmt::format(
            "#!/bin/sh\nprintf '%s\\n' {} \"$@\" >> '{}'\n{}",
            name,
            (mFolder / "calls").string(),
            body
        );
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }

  private:
    std::filesystem::path mFolder;
    std::string mPath;
};

} // namespace shutter::cli
