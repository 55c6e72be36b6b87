// SPDX-License-Identifier: MIT
// Options as words of a command line, and the errors for wrong ones.
#pragma once

#include "engine/core/result.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace shutter::game {

using Words = std::vector<std::string>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class T> [[nodiscard]] std::string wordOf(const T& value) {
    return fmt::format("{}", value);
}

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

/// The error names `option`, is one line and ends without a full stop.
template <class T> void expectRefused(const core::Result<T>& result, const std::string& option) {
    ASSERT_FALSE(result.ok()) << option;
    const std::string& message = result.error().message;
    EXPECT_NE(message.find(option), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.back(), '.') << message;
}

} // namespace shutter::game
