// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace shutter::test {

/// A folder that no other test uses, even when ctest runs several at a time; it is removed with its
/// contents. Throws std::runtime_error when it cannot be made.
class TempFolder {
  public:
    TempFolder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "shutter_test_XXXXXX").string();
        if (!mkdtemp(name.data()))
            throw std::runtime_error("cannot make a temporary folder");
        mPath = name;
    }

    ~TempFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(mPath, ignored);
    }

    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return mPath; }

    std::filesystem::path write(const std::string& name, std::string_view content) const {
        const std::filesystem::path file = mPath / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary)
            .write(content.data(), std::streamsize(content.size()));
        return file;
    }

  private:
    std::filesystem::path mPath;
};

[[nodiscard]] inline size_t countFiles(const std::filesystem::path& folder) {
    return size_t(std::distance(
        std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()
    ));
}

} // namespace shutter::test
