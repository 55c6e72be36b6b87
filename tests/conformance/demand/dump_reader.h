// SPDX-License-Identifier: MIT
// What a frame was made of, from the text that the render graph gives of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shutter::demand {

/// A line each, as it stands in graph::dump().
struct GraphParts {
    std::vector<std::string> passes;
    std::vector<std::string> images;
    std::vector<std::string> buffers;
};

[[nodiscard]] GraphParts readDump(std::string_view dump);

/// How many of `lines` have no equal among `others`, each of which answers for one.
[[nodiscard]] size_t
countBeyond(const std::vector<std::string>& lines, const std::vector<std::string>& others);

} // namespace shutter::demand
