// SPDX-License-Identifier: MIT
// A near field over a far field, as in Sousa 2013, "CryENGINE 3 Graphics Gems", and Abadie 2018,
// "A Life of a Bokeh".
#include "spirv/depth_of_field/near_far.comp.h"

#include "modules/depth_of_field/filters.h"

namespace shutter::depth_of_field {

extern const Filter kNearFar;

const Filter kNearFar = {
    .name = "near_far",
    .publication = "Sousa 2013, Abadie 2018",
    .spirv = depth_of_field_near_far_comp,
};

} // namespace shutter::depth_of_field
