// SPDX-License-Identifier: MIT
// Shared by the fuzzers: readers take paths, and report errors in one sentence.
#pragma once

#include "engine/core/check.h"
#include "engine/core/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace shutter::fuzz {

/// Bytes from libFuzzer as text.
inline std::string_view asText(const uint8_t* data, size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Writes the bytes to a file in the working folder, over those of the input before.
inline std::filesystem::path
writeInput(const uint8_t* data, size_t size, const char* name = "fuzz_input") {
    std::ofstream stream(name, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(data), std::streamsize(size));
    stream.close();
    SHUTTER_CHECK(stream.good(), "the working folder cannot be written");
    return name;
}

/// Ends the program unless the error is one line that holds `name`.
inline void expectSentence(const core::Error& error, std::string_view name = "fuzz_input") {
    SHUTTER_CHECK(
        error.message.find(name) != std::string::npos, "'{}' is not named: {}", name, error.message
    );
    SHUTTER_CHECK(error.message.find('\n') == std::string::npos, "two lines: {}", error.message);
}

} // namespace shutter::fuzz
