// SPDX-License-Identifier: MIT
// make_page FOLDER: the report page of FOLDER/results.json, for the tests that open it in a
// browser.
#include "game/bench/report/report_page.h"

#include <cstdio>

int main(int argc, char** argv) {
    if (const shutter::core::Status possible = shutter::bench::checkReportPageCanBeMade();
        !possible) {
        std::fprintf(stderr, "%s\n", possible.error().message.c_str());
        return 77; // the tests skip
    }
    if (argc != 2) {
        std::fputs("usage: test_report_make_page FOLDER\n", stderr);
        return 2;
    }
    const shutter::core::Status made = shutter::bench::remakeReportPage(argv[1]);
    if (!made)
        std::fprintf(stderr, "%s\n", made.error().message.c_str());
    return made ? 0 : 1;
}
