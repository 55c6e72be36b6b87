// SPDX-License-Identifier: MIT
// A near field over what rays see past it, as in Tan, Chua, Biette and Bhojan 2020, "Hybrid DoF:
// Ray-Traced and Post-Processed Hybrid Depth of Field Effect for Real-Time Rendering".
#include "spirv/depth_of_field/hybrid.comp.h"

#include "modules/depth_of_field/filters.h"

namespace shutter::depth_of_field {

extern const Filter kHybrid;

const Filter kHybrid = {
    .name = "hybrid",
    .publication = "Tan et al. 2020, 2022",
    .tracesRays = true,
    .spirv = depth_of_field_hybrid_comp,
};

} // namespace shutter::depth_of_field
