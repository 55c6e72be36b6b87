// SPDX-License-Identifier: MIT
// Shots with a lens, most of them of rooms: added objects, their motion, and the camera.
#pragma once

#include "assets/generator/gltf_writer.h"

#include <span>

namespace shutter::generator {

/// Name of the camera that has the lens.
inline constexpr const char* kLensCamera = "lens";

struct LensShot {
    const char* name;        ///< [a-z]
    const char* title;       ///< for people
    const char* description; ///< one sentence
    /// Binary glTF file, relative to the folder of rooms; null: the shot has all that it shows.
    const char* room;
    /// Adds the camera kLensCamera, laid out for an exposure of kExposureSeconds that ends at time
    /// 0, and the shot's objects besides the room.
    void (*furnish)(GltfWriter& writer);
};

/// In the order in which they are meant to be read.
[[nodiscard]] std::span<const LensShot> listLensShots();

} // namespace shutter::generator
