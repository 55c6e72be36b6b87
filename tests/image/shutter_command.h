// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace shutter::test {

/// Runs `shutter render` with validation on, writes to a file of its own below the build folder and
/// reads it back. Fails the test (empty picture) with the program's words where it does not exit
/// with 0.
/// \param extension of the picture, ".exr" (linear) or ".png" (as displayed)
/// \param name of the file, told apart among all tests that may run at once
[[nodiscard]] image::Image renderWithShutter(
    const std::string& name,
    const std::string& extension,
    const std::filesystem::path& scene,
    const std::vector<std::string>& arguments
);

/// Where this build's files are, the generated scenes among them.
[[nodiscard]] std::filesystem::path buildFolder();

/// What lies beside the project: scenes and references.
[[nodiscard]] std::filesystem::path sharedFolder();

} // namespace shutter::test
