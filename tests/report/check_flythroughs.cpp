// SPDX-License-Identifier: MIT
// Reads each named flythrough and prints a line for it: empty, or the error.
#include "engine/flythrough/flythrough.h"

#include <fmt/format.h>

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        const auto read = shutter::flythrough::readFlythrough(argv[i]);
        fmt::print("{}\n", read ? "" : read.error().message);
    }
    return 0;
}
