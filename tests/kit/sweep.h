// SPDX-License-Identifier: MIT
// How much of a sweep over hosts, scenes or methods a run of the tests draws.
#pragma once

#include <cstdlib>

namespace shutter::test {

/// Whether long sweeps draw every case instead of a sample: SHUTTER_ALL is set (tests/README.md).
[[nodiscard]] inline bool drawsAll() {
    return std::getenv("SHUTTER_ALL") != nullptr;
}

} // namespace shutter::test
