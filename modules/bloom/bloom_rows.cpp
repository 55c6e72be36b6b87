// SPDX-License-Identifier: MIT
#include "modules/bloom/bloom.h"

#include <array>

namespace shutter::bloom {

core::SettingRows<BloomSettings> listBloomRows() {
    using S = BloomSettings;
    static const std::array<core::SettingRow<S>, 3> kRows = {{
        {"bloomShare",
         &S::share,
         "",
         {.lowest = 0, .highest = 1},
         "Share of the light of highlights that the lens scatters, so that they glow. 0: no bloom.",
         "Bloom",
         "--bloom"},
        {"bloomThreshold",
         &S::threshold,
         "",
         {.lowest = 0, .highest = kMaxThreshold, .sliderLowest = 0, .sliderHighest = 4},
         "Light above which a pixel is a highlight. 0: all light is scattered.",
         "Bloom from",
         "--bloom-threshold"},
        {"bloomKnee",
         &S::knee,
         "",
         {.lowest = 0, .highest = 1},
         "How far around that light highlights set in, as a share of it.",
         "Bloom's knee",
         "--bloom-knee"},
    }};
    return kRows;
}

} // namespace shutter::bloom
