// SPDX-License-Identifier: MIT
#include "game/bench/journal.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    const bench::Journal journal(fuzz::writeInput(data, size), "fingerprint");
    for (const auto& [key, record] : journal.records())
        SHUTTER_CHECK(&journal.find(key) == &record, "'{}' is not found", key);
    return 0;
}
