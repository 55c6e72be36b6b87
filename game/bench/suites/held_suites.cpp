// SPDX-License-Identifier: MIT
// Suites whose figures are held against bounds instead of compared with the truth.
#include "game/bench/suites/suite.h"

namespace shutter::bench {

Suite makeDemandSuite() {
    Suite suite;
    suite.name = "demand";
    suite.size = {1280, 720};
    suite.claims = demand::listClaims();
    return suite;
}

Suite makeStabilitySuite() {
    Suite suite;
    suite.name = "stability";
    suite.repeats = 1;
    suite.hardCases = stability::listHardCases();
    return suite;
}

} // namespace shutter::bench
