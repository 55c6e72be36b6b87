// SPDX-License-Identifier: MIT
#include "modules/shadows/shadow_settings.h"

#include <array>

namespace shutter::shadows {

core::SettingRows<ShadowSettings> listShadowRows() {
    using S = ShadowSettings;
    static constexpr std::string_view kModes[] = {"none", "sharp", "blurred"};
    static const std::array<core::SettingRow<S>, 4> kRows = {{
        {"shadows",
         core::makeWordField<&S::mode>(kModes),
         "",
         {},
         "Shadows of lights: sharp, or blurred like what casts them.",
         "Shadows",
         "--shadows"},
        {"shadowMapSize",
         &S::mapSize,
         "texels",
         {.lowest = 64, .highest = 8192, .step = 64, .isLogarithmic = true},
         "Width of a shadow map. Larger maps have finer edges and take more memory and time.",
         "Shadow maps",
         "--shadow-map-size"},
        {"shadowDistance",
         &S::distance,
         "m",
         {.lowest = 0, .highest = 1e6, .sliderHighest = 200},
         "How far directional lights cast shadows. 0: as far as the scene reaches.",
         "Shadows up to",
         "--shadow-distance"},
        {"shadowInstants",
         &S::instants,
         "instants",
         {.lowest = 1, .highest = 64, .step = 1},
         "Instants of the exposure that a blurred shadow is the mean of.",
         "Shadow instants",
         "--shadow-instants"},
    }};
    return kRows;
}

} // namespace shutter::shadows
