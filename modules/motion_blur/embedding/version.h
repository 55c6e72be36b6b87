// SPDX-License-Identifier: MIT
// The version of the embedding, in these headers and in the library that they are linked with.
#pragma once

#include "engine/core/result.h"

#include <cstdint>

namespace shutter::motion_blur {

/// Version of these headers: major, minor and patch, packed as by VK_MAKE_API_VERSION.
inline constexpr uint32_t kHeaderVersion = 0u << 22 | 1u << 12 | 0u;

/// Whether a host compiled with headers of this version may use the library: the same major and
/// minor version, and a patch that is not newer. The error names both versions.
[[nodiscard]] core::Status checkVersion(uint32_t headerVersion = kHeaderVersion);

} // namespace shutter::motion_blur
