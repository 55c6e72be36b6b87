// SPDX-License-Identifier: MIT
#include "game/bench/suites.h"

namespace shutter::bench {

Suite makeDemandSuite() {
    Suite suite;
    suite.name = "demand";
    suite.size = "1280x720";
    suite.claims = demand::listClaims();
    return suite;
}

} // namespace shutter::bench
