// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/claim.h"

namespace shutter::demand {

std::vector<Claim> listClaims() {
    return {
        makeStillClaim(),
        makeMovingShareClaim(),
        makeRevealClaim(),
        makeEntitiesClaim(),
        makeLitClaim()};
}

} // namespace shutter::demand
