// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace shutter::core {

/// Whether something runs, and why.
struct Decision {
    bool run = false;
    std::string reason; ///< for a person; continues "because"
};

/// "ran: ..." or "skipped: ...".
[[nodiscard]] inline std::string describe(const Decision& decision) {
    return (decision.run ? "ran: " : "skipped: ") + decision.reason;
}

} // namespace shutter::core
