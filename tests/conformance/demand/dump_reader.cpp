// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/dump_reader.h"

#include <algorithm>
#include <cctype>

namespace shutter::demand {

GraphParts readDump(std::string_view dump) {
    // A section is a line "name: count" and, indented by two, a line for each; what belongs to one
    // of those is indented farther.
    GraphParts parts;
    std::vector<std::string>* section = nullptr;
    while (!dump.empty()) {
        const size_t end = dump.find('\n');
        const std::string_view line = dump.substr(0, end);
        dump.remove_prefix(end == std::string_view::npos ? dump.size() : end + 1);
        if (line.empty())
            continue;
        if (line.front() != ' ') {
            section = line.starts_with("passes:")    ? &parts.passes
                      : line.starts_with("images:")  ? &parts.images
                      : line.starts_with("buffers:") ? &parts.buffers
                                                     : nullptr;
            continue;
        }
        const bool isEntry = line.starts_with("  ") && line.size() > 2 && line[2] != ' ';
        if (section == nullptr || !isEntry)
            continue;
        // "3 'tile max' (compute)": its place in the frame is not part of it.
        std::string_view entry = line.substr(2);
        if (section == &parts.passes) {
            const size_t name = entry.find('\'');
            if (name == std::string_view::npos)
                continue; // barriers at the frame's end
            if (!std::isdigit(static_cast<unsigned char>(entry.front())))
                continue;
            entry.remove_prefix(name);
        }
        section->emplace_back(entry);
    }
    return parts;
}

size_t countBeyond(const std::vector<std::string>& lines, const std::vector<std::string>& others) {
    std::vector<std::string> left = others;
    size_t beyond = 0;
    for (const std::string& line : lines) {
        const auto same = std::find(left.begin(), left.end(), line);
        if (same == left.end())
            ++beyond;
        else
            left.erase(same);
    }
    return beyond;
}

} // namespace shutter::demand
