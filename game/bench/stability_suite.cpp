// SPDX-License-Identifier: MIT
#include "game/bench/suites.h"

namespace shutter::bench {

Suite makeStabilitySuite() {
    Suite suite;
    suite.name = "stability";
    suite.repeats = 1;
    suite.hardCases = stability::listHardCases();
    return suite;
}

} // namespace shutter::bench
