// SPDX-License-Identifier: MIT
#include "game/parts/part_work.h"

#include "engine/io/file_bytes.h"

#include <fmt/format.h>

#include <system_error>

namespace shutter::parts {

namespace fs = std::filesystem;

fs::path deviceFile(const fs::path& folder) {
    return folder / "device.json";
}

fs::path jobsFile(const fs::path& folder) {
    return folder / "jobs.json";
}

fs::path partLog(const fs::path& folder, uint32_t part) {
    return folder / fmt::format("part_{}.log", part);
}

fs::path finishLog(const fs::path& folder) {
    return folder / "finish.log";
}

void removePartFiles(const fs::path& folder, uint32_t partCount) {
    std::error_code ignored;
    for (uint32_t part = 0; part < partCount; ++part)
        fs::remove(partLog(folder, part), ignored);
    for (const fs::path& file : {deviceFile(folder), jobsFile(folder), finishLog(folder)})
        fs::remove(file, ignored);
    io::removeTemporaryFiles(folder);
}

std::string findLastSentence(std::string_view output) {
    const size_t end = output.find_last_not_of(" \r\n");
    if (end == std::string_view::npos)
        return {};
    output = output.substr(0, end + 1);
    const size_t start = output.rfind('\n');
    std::string_view line = start == std::string_view::npos ? output : output.substr(start + 1);
    constexpr std::string_view kName = "shutter: ";
    if (line.starts_with(kName))
        line.remove_prefix(kName.size());
    return std::string(line);
}

} // namespace shutter::parts
