// SPDX-License-Identifier: MIT
#pragma once

#include "assets/generator/gltf_writer.h"

namespace shutter::generator {

/// The still part of the vase scene: wall, floor, white sofa with a pink cushion at its left, lamp,
/// table, picture. The sofa faces +Z; nothing of it reaches further than z = -0.5 m.
void addRoom(GltfWriter& writer);

/// `sun` and `fill_lamp`.
void addRoomLights(GltfWriter& writer);

} // namespace shutter::generator
