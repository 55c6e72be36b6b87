// SPDX-License-Identifier: MIT
// Light that comes from everywhere, as pictures of all directions. Plain data in main memory.
//
// The pictures are equirectangular: u runs once round the horizon, v from the zenith (0) to the
// nadir (1). The middle of a picture lies towards -Z, the forward direction of an unrotated camera;
// +X lies a quarter of its width to the right.
#pragma once

#include "engine/math/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace shutter::scene {

/// Linear radiance in every direction, row 0 at the zenith.
struct DirectionPicture {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint16_t> rgba; ///< half floats, width * height * 4
};

/// Image-based light of a scene, in addition to its lights. Made by engine/environment.
struct Environment {
    /// The background: a pyramid of at least one level, each half as wide and high as the one
    /// before (rounded down, at least 1).
    std::vector<DirectionPicture> background;
    /// Prefiltered reflections: at least one level, each half as wide and high as the one before.
    /// Number i is filtered for the perceptual roughness i / (number of them - 1), as if n = v = r
    /// (Karis 2013).
    std::vector<DirectionPicture> mirrored;
    /// Irradiance over pi of a surface with unit normal n, by real spherical harmonics whose
    /// constants are folded in: factors of 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2
    /// (Ramamoorthi 2001, eq. 13).
    std::array<math::vec3, 9> irradiance{};
    math::mat3 mapFromWorld{1.0f}; ///< a rotation
};

} // namespace shutter::scene
