// SPDX-License-Identifier: MIT
// make_page FOLDER [BYTES]: the report page of FOLDER/results.json, of at most so many bytes, for
// the tests that open it in a browser.
#include "game/bench/report/report_page.h"

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
    if (const shutter::core::Status possible = shutter::bench::checkReportPageCanBeMade();
        !possible) {
        std::fprintf(stderr, "%s\n", possible.error().message.c_str());
        return 77; // the tests skip
    }
    if (argc != 2 && argc != 3) {
        std::fputs("usage: test_report_make_page FOLDER [BYTES]\n", stderr);
        return 2;
    }
    const size_t bytes = argc == 3 ? std::stoul(argv[2]) : shutter::bench::kMaxPageBytes;
    const shutter::core::Status made = shutter::bench::remakeReportPage(argv[1], bytes);
    if (!made)
        std::fprintf(stderr, "%s\n", made.error().message.c_str());
    return made ? 0 : 1;
}
