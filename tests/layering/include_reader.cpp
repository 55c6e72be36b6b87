// SPDX-License-Identifier: MIT
#include "tests/layering/include_reader.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

namespace shutter::layering {

namespace {

std::string_view trimLeft(std::string_view text) {
    const size_t start = text.find_first_not_of(" \t");
    return start == std::string_view::npos ? std::string_view() : text.substr(start);
}

/// Whether the line is an #include; leaves what follows the word in `rest`.
bool splitDirective(std::string_view line, std::string_view& rest) {
    line = trimLeft(line);
    if (!line.starts_with('#'))
        return false;
    line = trimLeft(line.substr(1));
    constexpr std::string_view kWord = "include";
    if (!line.starts_with(kWord))
        return false;
    rest = trimLeft(line.substr(kWord.size()));
    return true;
}

bool isSource(const std::filesystem::path& path) {
    static const std::set<std::string> kNoSources = {".md", ".txt", ".json", ".cmake"};
    return !kNoSources.contains(path.extension().string());
}

} // namespace

std::string blankComments(std::string_view text) {
    enum class State { Code, String, LineComment, BlockComment };
    std::string result(text);
    State state = State::Code;
    for (size_t i = 0; i < text.size(); ++i) {
        const char next = i + 1 < text.size() ? text[i + 1] : '\0';
        switch (state) {
        case State::Code:
            if (text[i] == '"')
                state = State::String;
            else if (text[i] == '/' && next == '/')
                state = State::LineComment;
            else if (text[i] == '/' && next == '*')
                state = State::BlockComment;
            break;
        case State::String:
            if (text[i] == '\\')
                ++i;
            else if (text[i] == '"' || text[i] == '\n') // a lone quote ends with its line
                state = State::Code;
            break;
        case State::LineComment:
            if (text[i] == '\n')
                state = State::Code;
            break;
        case State::BlockComment:
            if (text[i] == '*' && next == '/') {
                result[i] = result[i + 1] = ' ';
                ++i;
                state = State::Code;
            }
            break;
        }
        if ((state == State::LineComment || state == State::BlockComment) && text[i] != '\n')
            result[i] = ' ';
    }
    return result;
}

std::vector<Include> readIncludes(std::string_view file, std::string_view text) {
    std::vector<Include> includes;
    const std::string code = blankComments(text);
    size_t lineNumber = 0;
    for (size_t start = 0; start < code.size();) {
        const size_t end = std::min(code.find('\n', start), code.size());
        ++lineNumber;
        std::string_view rest;
        if (splitDirective(std::string_view(code).substr(start, end - start), rest)) {
            Include include{std::string(file), lineNumber, {}, rest.starts_with('"')};
            const char closing = include.quoted ? '"' : '>';
            const size_t close = rest.find(closing, 1);
            if ((include.quoted || rest.starts_with('<')) && close != std::string_view::npos)
                include.target = rest.substr(1, close - 1);
            includes.push_back(std::move(include));
        }
        start = end + 1;
    }
    return includes;
}

std::vector<Include> collectIncludes(const std::filesystem::path& root, std::string_view folder) {
    std::vector<std::filesystem::path> files;
    const std::filesystem::path top = root / folder;
    if (!std::filesystem::is_directory(top))
        return {};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top))
        if (entry.is_regular_file() && isSource(entry.path()))
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());

    std::vector<Include> includes;
    for (const std::filesystem::path& path : files) {
        std::ifstream stream(path, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        auto found = readIncludes(path.lexically_relative(root).generic_string(), text);
        std::move(found.begin(), found.end(), std::back_inserter(includes));
    }
    return includes;
}

} // namespace shutter::layering
