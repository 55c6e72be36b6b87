// SPDX-License-Identifier: MIT
#include "tests/layering/nan_comparisons.h"

#include "tests/layering/include_reader.h"

#include <array>
#include <cstddef>
#include <regex>
#include <sstream>

namespace shutter::layering {

namespace {

struct Rule {
    std::regex pattern;
    const char* says; ///< what follows "file:line "
};

const std::array<Rule, 3>& rules() {
    // An operand: a name, members and indices; a call's result has no name to be compared by.
    static const std::array kRules{
        Rule{
            std::regex(R"((^|[^\w.\]])([A-Za-z_]\w*(?:\.\w+|\[\w+\])*)\s*[!=]=\s*\2(?![\w.\[(]))"),
            "compares a value with itself"},
        Rule{std::regex(R"((^|[^\w])is(nan|inf)\s*\()"), "asks isnan or isinf"},
        Rule{
            std::regex(R"(([<>]|[<>=!]=)\s*-?3\.4\d*e\+?38)", std::regex::icase),
            "compares with the largest float"},
    };
    return kRules;
}

} // namespace

std::vector<std::string> findNanComparisons(std::string_view file, std::string_view text) {
    std::vector<std::string> found;
    std::istringstream lines(blankComments(text));
    size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        for (const Rule& rule : rules())
            if (std::regex_search(line, rule.pattern))
                found.push_back(std::string(file) + ":" + std::to_string(number) + " " + rule.says);
    }
    return found;
}

} // namespace shutter::layering
