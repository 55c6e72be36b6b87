// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/setting_row.h"

namespace shutter::particles {

struct ParticleSettings {
    bool areShown = true; ///< those of the world's emitters
};

/// Names and options of ParticleSettings.
[[nodiscard]] core::SettingRows<ParticleSettings> listParticleRows();

} // namespace shutter::particles
