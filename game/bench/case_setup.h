// SPDX-License-Identifier: MIT
// A case's scene on disk, and a name for everything its pictures depend on.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device_select.h"
#include "game/bench/suites/suite.h"

#include <filesystem>
#include <string>

namespace shutter::bench {

struct CaseSetup {
    std::filesystem::path scene;
    /// Of the scene's bytes, the shot's options, this program and the device: pictures of equal
    /// hashes are equal, and their times comparable.
    std::string hash;
};

/// Writes a generated scene into folder/scenes/. Error: a file cannot be read or written.
[[nodiscard]] core::Result<CaseSetup>
setUpCase(const Case& shot, const gpu::DeviceInfo& device, const std::filesystem::path& folder);

} // namespace shutter::bench
