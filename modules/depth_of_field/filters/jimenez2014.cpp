// SPDX-License-Identifier: MIT
// Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare".
#include "spirv/depth_of_field/jimenez2014.comp.h"

#include "modules/depth_of_field/filters.h"

namespace shutter::depth_of_field {

extern const Filter kJimenez2014;

const Filter kJimenez2014 = {
    .name = "jimenez2014",
    .publication = "Jimenez 2014",
    .spirv = depth_of_field_jimenez2014_comp,
};

} // namespace shutter::depth_of_field
