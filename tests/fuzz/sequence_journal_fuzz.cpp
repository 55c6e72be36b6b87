// SPDX-License-Identifier: MIT
#include "game/output/sequence_journal.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    const auto journal = game::SequenceJournal::open(fuzz::writeInput(data, size), "fingerprint");
    if (!journal) {
        fuzz::expectSentence(journal.error());
        return 0;
    }
    for (const int frame : {-1, 0, 1})
        (void)journal.value().isComplete(
            frame, journal.value().file().parent_path() / "f_0000.png"
        );
    return 0;
}
