// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/setting_row.h"

#include <cstdint>

namespace shutter::shadows {

enum class ShadowMode : uint8_t {
    None,    ///< lights shine through everything
    Sharp,   ///< movers cast the shadow of the raster instant
    Blurred, ///< movers cast the shadow of the whole exposure
};

struct ShadowSettings {
    ShadowMode mode = ShadowMode::None;
    /// Width and height of a map, texels, [64, 8192], a multiple of 64: of each cascade of a
    /// directional light and of a spot's map. The six of a point light have half of it, a mover's
    /// layer a quarter.
    uint32_t mapSize = 1024;
    /// How far from the camera directional lights cast shadows, metres, [0, 1e6]; 0: as far as the
    /// scene reaches.
    double distance = 0.0;
    /// Instants of the exposure that a moving shadow is the mean of, [1, 64].
    uint32_t instants = 16;
};

/// Names, ranges and options of ShadowSettings.
[[nodiscard]] core::SettingRows<ShadowSettings> listShadowRows();

} // namespace shutter::shadows
