// SPDX-License-Identifier: MIT
// The methods there are, by name.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

enum class MethodId : uint8_t { Sharp, Gather, Hybrid, Accumulate };

struct MethodInfo {
    MethodId id;
    const char* name;
    const char* description;
    bool needsRays;
    uint32_t defaultSamples;       ///< 0: the method has no samples
    std::vector<std::string> aovs; ///< intermediates it writes beyond the G-buffer's
};

/// In the order in which quality rises.
[[nodiscard]] std::span<const MethodInfo> listMethods();

/// Error: the names there are.
[[nodiscard]] core::Result<const MethodInfo*> findMethod(std::string_view name);

} // namespace shutter::game
