// SPDX-License-Identifier: MIT
// Words of messages: counted nouns, and the name that a misspelt one resembles.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace shutter::core {

/// "1 frame", "2 frames". \param many of more and of none; empty: `one` and an s
[[nodiscard]] std::string countOf(uint64_t count, std::string_view one, std::string_view many = {});

/// "there is 1 frame", "there are 2 frames".
[[nodiscard]] std::string
thereAre(uint64_t count, std::string_view one, std::string_view many = {});

/// The name that `text` is a misspelling of: the one that the fewest typing errors lead to, each a
/// letter more, less or changed, or two letters exchanged. Empty: no name is within a third of its
/// letters. The first of equally near names counts.
[[nodiscard]] std::string findNearest(std::string_view text, std::span<const std::string> names);

} // namespace shutter::core
