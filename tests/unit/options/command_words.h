// SPDX-License-Identifier: MIT
// Options as words of a command line, as the program takes them.
#pragma once

#include "engine/core/result.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace shutter::game {

using Words = std::vector<std::string>;

/// Parses as the program does. \param define adds the options to a CLI::App
template <class Define> [[nodiscard]] core::Status parseWords(Words words, const Define& define) {
    CLI::App app;
    define(app);
    // An empty value has to be a separate word, or the next word is taken for it.
    for (size_t i = 0; i < words.size(); ++i)
        if (words[i].size() > 2 && words[i].back() == '=') {
            words[i].pop_back();
            words.insert(words.begin() + ptrdiff_t(i) + 1, std::string());
        }
    std::reverse(words.begin(), words.end()); // as CLI11 takes them
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        return core::Error{error.what()};
    }
    return {};
}

} // namespace shutter::game
