// SPDX-License-Identifier: MIT
#include "game/play/loop/shader_reload.h"

#include "engine/gpu/replaced_shader.h"
#include "engine/io/file_bytes.h"
#include "engine/io/process.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <sstream>
#include <system_error>
#include <utility>

namespace shutter::game {

namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMostBytes = 16ull << 20;
constexpr const char* kTarget = "shutter_spirv"; // cmake/ShutterTools.cmake

core::Result<std::vector<uint32_t>> readWords(const fs::path& path) {
    auto bytes = io::readFileBytes(path, kMostBytes);
    if (!bytes)
        return bytes.error();
    std::vector<uint32_t> words(bytes.value().size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.value().data(), words.size() * sizeof(uint32_t));
    return words;
}

/// The nearest folder above that CMake has configured; empty: none.
fs::path findBuildFolder(const fs::path& folder) {
    std::error_code ignored;
    for (fs::path at = fs::absolute(folder, ignored); at != at.parent_path(); at = at.parent_path())
        if (fs::exists(at / "CMakeCache.txt", ignored))
            return at;
    return {};
}

} // namespace

std::string findCompilerError(const std::string& printed) {
    std::istringstream lines(printed);
    std::string first;
    for (std::string line; std::getline(lines, line);) {
        std::string lower(line.size(), ' ');
        std::transform(line.begin(), line.end(), lower.begin(), [](unsigned char c) {
            return static_cast<char>(std::tolower(c));
        });
        if (lower.find("error:") != std::string::npos)
            return line;
        if (first.empty())
            first = line;
    }
    return first;
}

core::Status ShaderReload::open(const fs::path& folder) {
    std::error_code failed;
    for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end;
         at.increment(failed)) {
        if (at->path().extension() != ".spv")
            continue;
        auto words = readWords(at->path());
        if (!words)
            return core::makeError("--shader-folder: {}", words.error().message);
        mFiles.push_back(
            {at->path(),
             at->path().lexically_relative(folder).replace_extension().string(),
             words.value(),
             words.value()}
        );
    }
    if (failed)
        return core::makeError("--shader-folder {}: {}", folder.string(), failed.message());
    if (mFiles.empty())
        return core::makeError("--shader-folder {} holds no .spv file", folder.string());
    mBuildFolder = findBuildFolder(folder);
    return {};
}

core::Status ShaderReload::build() const {
    if (mBuildFolder.empty())
        return {};
    const auto cmake = io::findProgram("cmake");
    if (!cmake)
        return core::makeError("cmake, which builds the shaders, is not on PATH");
    const auto built = io::runProcess(*cmake, {"--build", ".", "--target", kTarget}, mBuildFolder);
    if (!built)
        return built.error();
    if (built.value().exitStatus != 0)
        return core::makeError(
            "{}", findCompilerError(built.value().output + '\n' + built.value().errors)
        );
    return {};
}

core::Result<std::vector<std::string>> ShaderReload::reload() {
    SHUTTER_TRY(build());
    std::vector<std::string> changed;
    std::vector<gpu::ReplacedShader> replaced;
    std::vector<File> files = mFiles;
    for (File& file : files) {
        auto words = readWords(file.path);
        if (!words)
            return words.error();
        if (words.value() != file.now)
            changed.push_back(file.name);
        file.now = std::move(words).value();
        if (file.now == file.own)
            continue;
        replaced.push_back({file.own, file.now});
        if (const core::Status fits = gpu::checkReplacement(replaced.back()); !fits)
            return core::makeError("{}: {}", file.name, fits.error().message);
    }
    mFiles = std::move(files);
    if (!changed.empty())
        gpu::replaceShaders(std::move(replaced));
    return changed;
}

} // namespace shutter::game
