// SPDX-License-Identifier: MIT
// Shaders that change while the program runs: the SPIR-V files of a build's folder, built and read
// again when a key asks for it.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shutter::game {

class ShaderReload {
  public:
    /// Reads the shaders of the program's own build, before any of them changes.
    /// \param folder with .spv files, as <build>/generated/spirv. Error: there are none, or one
    /// that cannot be read
    [[nodiscard]] core::Status open(const std::filesystem::path& folder);

    [[nodiscard]] bool isOpen() const { return !mFiles.empty(); }

    /// Builds the shaders, where the folder lies in a CMake build folder, reads them, and has
    /// pipelines made of them from now on (gpu::replaceShaders). Waits for the compiler.
    /// \return names of those that changed since the last call
    /// Error: one sentence, the compiler's where it refused one; then nothing has changed
    [[nodiscard]] core::Result<std::vector<std::string>> reload();

  private:
    struct File {
        std::filesystem::path path;
        std::string name; ///< "bloom/bloom_up.comp"
        std::vector<uint32_t> own;
        std::vector<uint32_t> now;
    };

    [[nodiscard]] core::Status build() const;

    std::vector<File> mFiles;
    std::filesystem::path mBuildFolder; ///< empty: nothing is built
};

/// The sentence to show of what a compiler or a build printed: the first line with an error.
[[nodiscard]] std::string findCompilerError(const std::string& printed);

} // namespace shutter::game
