// SPDX-License-Identifier: MIT
#include "game/options/error_output.h"

#include <algorithm>
#include <cstdio>

namespace shutter::game {

std::string toOneLine(std::string text) {
    // Bytes of UTF-8 are 0x80 and above and stay.
    std::replace_if(
        text.begin(),
        text.end(),
        [](char c) {
            const auto byte = static_cast<unsigned char>(c);
            return byte < 0x20 || byte == 0x7F;
        },
        ' '
    );
    return text;
}

void printError(const core::Error& error) {
    fmt::print(stderr, "shutter: {}\n", toOneLine(error.message));
}

int fail(int status, const core::Error& error) {
    printError(error);
    return status;
}

} // namespace shutter::game
