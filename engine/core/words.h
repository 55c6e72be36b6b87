// SPDX-License-Identifier: MIT
// Formats counted nouns for messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace shutter::core {

/// "1 frame", "2 frames". \param many of more and of none; empty: `one` and an s
[[nodiscard]] std::string countOf(uint64_t count, std::string_view one, std::string_view many = {});

/// "there is 1 frame", "there are 2 frames".
[[nodiscard]] std::string
thereAre(uint64_t count, std::string_view one, std::string_view many = {});

} // namespace shutter::core
