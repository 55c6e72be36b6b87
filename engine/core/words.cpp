// SPDX-License-Identifier: MIT
#include "engine/core/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace shutter::core {

namespace {

/// The number of typing errors between two words (optimal string alignment distance).
size_t countTypingErrors(std::string_view a, std::string_view b) {
    const size_t width = b.size() + 1;
    std::vector<size_t> errors((a.size() + 1) * width);
    const auto at = [&](size_t i, size_t j) -> size_t& { return errors[i * width + j]; };
    for (size_t i = 0; i <= a.size(); ++i)
        for (size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                at(i, j) = i + j;
                continue;
            }
            const size_t changed = a[i - 1] == b[j - 1] ? 0 : 1;
            at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + changed});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
        }
    return errors.back();
}

} // namespace

std::string countOf(uint64_t count, std::string_view one, std::string_view many) {
    if (count == 1)
        return fmt::format("1 {}", one);
    return many.empty() ? fmt::format("{} {}s", count, one) : fmt::format("{} {}", count, many);
}

std::string thereAre(uint64_t count, std::string_view one, std::string_view many) {
    return (count == 1 ? "there is " : "there are ") + countOf(count, one, many);
}

std::string findNearest(std::string_view text, std::span<const std::string> names) {
    // Longer words are not names; they would only take time.
    constexpr size_t kMaxLetters = 64;
    std::string nearest;
    size_t fewest = std::max<size_t>(text.size() / 3, 1) + 1;
    if (text.size() > kMaxLetters)
        return nearest;
    for (const std::string& name : names)
        if (const size_t errors = countTypingErrors(text, name);
            errors < fewest && errors < name.size()) {
            fewest = errors;
            nearest = name;
        }
    return nearest;
}

} // namespace shutter::core
