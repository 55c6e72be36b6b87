// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/claim.h"

namespace shutter::demand {

std::vector<Claim> listClaims() {
    return {
        makeStillClaim(),
        makeMovingShareClaim(),
        makeRevealClaim(),
        makeEntitiesClaim(),
        makeFullScreenClaim(),
        makeMethodsClaim(),
        makeTraversalClaim(),
        makeInstantsClaim(),
        makeLitClaim(),
        makeTogglesClaim()};
}

} // namespace shutter::demand
