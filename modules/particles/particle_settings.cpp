// SPDX-License-Identifier: MIT
#include "modules/particles/particle_settings.h"

#include <array>

namespace shutter::particles {

core::SettingRows<ParticleSettings> listParticleRows() {
    static const std::array<core::SettingRow<ParticleSettings>, 1> kRows = {{
        {"particles",
         &ParticleSettings::areShown,
         "",
         {},
         "Sparks, dust, smoke and other particles of the scene.",
         "Particles",
         "--particles"},
    }};
    return kRows;
}

} // namespace shutter::particles
