// SPDX-License-Identifier: MIT
#include "engine/core/words.h"

#include <fmt/format.h>

namespace shutter::core {

std::string countOf(uint64_t count, std::string_view one, std::string_view many) {
    if (count == 1)
        return fmt::format("1 {}", one);
    return many.empty() ? fmt::format("{} {}s", count, one) : fmt::format("{} {}", count, many);
}

std::string thereAre(uint64_t count, std::string_view one, std::string_view many) {
    return (count == 1 ? "there is " : "there are ") + countOf(count, one, many);
}

} // namespace shutter::core
