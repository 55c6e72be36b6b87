// SPDX-License-Identifier: MIT
// Shaders that take the places of those built in, for people who work on them while the program
// runs. They count for the whole process, since built-in shaders do.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gpu {

struct ReplacedShader {
    std::vector<uint32_t> own; ///< SPIR-V as it is built in
    std::vector<uint32_t> now; ///< SPIR-V in its place
};

/// For pipelines that are made from now on; those there are stay as they are. What an earlier call
/// replaced and this one does not is as it was built in. Memory of earlier calls is kept until the
/// process ends, since pipelines may be made of it on other threads.
void replaceShaders(std::vector<ReplacedShader> shaders);

/// What a pipeline is made of: `own`, or what takes its place.
[[nodiscard]] std::span<const uint32_t> findShader(std::span<const uint32_t> own);

/// Whether `now` can take the place of `own` in its pipeline: it must be SPIR-V and bind nothing
/// else. One sentence that says what does not fit.
[[nodiscard]] core::Status checkReplacement(const ReplacedShader& shader);

} // namespace shutter::gpu
