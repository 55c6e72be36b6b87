// SPDX-License-Identifier: MIT
// Tables of short texts.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace shutter::test {

/// "a|b||c": a, b, nothing, and c.
[[nodiscard]] inline std::vector<std::string> rowsOf(const std::string& text) {
    std::vector<std::string> rows;
    std::istringstream stream(text + '|');
    for (std::string row; std::getline(stream, row, '|');)
        rows.push_back(row);
    return rows;
}

} // namespace shutter::test
