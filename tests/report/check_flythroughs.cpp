// SPDX-License-Identifier: MIT
// Reads each flythrough that is named and prints a line for it: nothing, or what is wrong.
#include "engine/flythrough/flythrough.h"

#include <fmt/format.h>

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        const auto read = shutter::flythrough::readFlythrough(argv[i]);
        fmt::print("{}\n", read ? "" : read.error().message);
    }
    return 0;
}
