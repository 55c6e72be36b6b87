// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace shutter::bench {

/// RFC 4648, section 4: the standard alphabet, padded, without line breaks.
[[nodiscard]] std::string encodeBase64(std::span<const uint8_t> bytes);

} // namespace shutter::bench
