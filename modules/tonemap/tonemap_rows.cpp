// SPDX-License-Identifier: MIT
#include "modules/tonemap/tonemap.h"

#include <array>
#include <string_view>

namespace shutter::tonemap {

core::SettingRows<TonemapSettings> listTonemapRows() {
    using S = TonemapSettings;
    static constexpr std::string_view kOperators[] = {"none", "neutral"};
    static const std::array<core::SettingRow<S>, 2> kRows = {{
        {"exposureValue",
         &S::exposureValue,
         "stops",
         {.lowest = -32, .highest = 32, .sliderLowest = -8, .sliderHighest = 8},
         "Exposure before tone mapping: the picture is multiplied by 2 to this power.",
         "Brightness",
         "--ev"},
        {"tonemap",
         core::makeWordField<&S::op>(kOperators),
         "",
         {},
         "Tone mapper: neutral (Khronos PBR Neutral), or none, which clips values above 1.",
         "Tone mapper",
         "--tonemap"},
    }};
    return kRows;
}

} // namespace shutter::tonemap
