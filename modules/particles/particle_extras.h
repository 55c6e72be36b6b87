// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gltf/extras.h"

namespace shutter::particles {

/// Reads `extras.particles` of a node (README.md) with addEmitter().
extern const gltf::ExtraReader kParticleExtras;

} // namespace shutter::particles
