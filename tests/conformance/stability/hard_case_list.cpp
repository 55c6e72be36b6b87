// SPDX-License-Identifier: MIT
#include "tests/conformance/stability/case_lists.h"

#include <iterator>

namespace shutter::stability {

std::vector<HardCase> listHardCases() {
    std::vector<HardCase> all;
    for (const auto list :
         {listMotionCases,
          listPlaceCases,
          listHistoryCases,
          listSurfaceCases,
          listLimitCases,
          listEnergyCases,
          listRevealCases,
          listContinuityCases,
          listFunctionPrecisionCases,
          listPassPrecisionCases,
          listRepeatCases}) {
        std::vector<HardCase> cases = list();
        std::move(cases.begin(), cases.end(), std::back_inserter(all));
    }
    return all;
}

} // namespace shutter::stability
