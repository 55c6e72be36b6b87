// SPDX-License-Identifier: MIT
#include "tests/image/shutter_command.h"

#include "engine/io/image_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace shutter::test {

namespace {

/// As one word of a POSIX shell.
std::string quote(const std::string& word) {
    std::string quoted(1, '\'');
    for (char c : word)
        if (c == '\'')
            quoted.append("'\\''");
        else
            quoted.push_back(c);
    quoted.push_back('\'');
    return quoted;
}

std::string readText(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

} // namespace

std::filesystem::path buildFolder() {
    return SHUTTER_BUILD_DIR;
}

std::filesystem::path sharedFolder() {
    return SHUTTER_SHARED_DIR;
}

image::Image renderWithShutter(
    const std::string& name,
    const std::string& extension,
    const std::filesystem::path& scene,
    const std::vector<std::string>& arguments
) {
    const std::filesystem::path folder = buildFolder() / "test_pictures";
    std::filesystem::create_directories(folder);
    const std::filesystem::path picture = folder / (name + extension);
    const std::filesystem::path messages = folder / (name + ".log");
    std::filesystem::remove(picture);
    std::string command = fmt::format(
        "{} render {} --validate --out {}",
        quote(SHUTTER_EXECUTABLE),
        quote(scene.string()),
        quote(picture.string())
    );
    for (const std::string& argument : arguments)
        command += " " + quote(argument);
    command += " > " + quote(messages.string()) + " 2>&1";
    if (std::system(command.c_str()) != 0) {
        ADD_FAILURE() << command << "\n" << readText(messages);
        return {};
    }
    auto read = io::readImage(picture);
    if (!read) {
        ADD_FAILURE() << read.error().message;
        return {};
    }
    return std::move(read).value();
}

} // namespace shutter::test
