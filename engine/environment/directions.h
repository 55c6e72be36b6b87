// SPDX-License-Identifier: MIT
// Equirectangular float pictures under construction, sampled bilinearly.
#pragma once

#include "engine/image/image.h"
#include "engine/math/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace shutter::environment {

/// Unit direction of a place in an equirectangular picture. \param uv (0, 0): its top left corner
[[nodiscard]] math::dvec3 directionAt(math::dvec2 uv);

/// The inverse: u in [0, 1], v in [0, 1]. \param direction unit
[[nodiscard]] math::dvec2 placeOf(math::dvec3 direction);

/// Solid angle of a texel in row `row` of `height` rows of `width` texels, steradians.
[[nodiscard]] double texelSolidAngle(uint32_t row, uint32_t width, uint32_t height);

/// Colour between the four nearest texels; u wraps, v is clamped at the poles. At least three
/// channels, of which the first three count.
[[nodiscard]] math::vec3 samplePlace(const image::Image& picture, math::dvec2 uv);
[[nodiscard]] math::vec3 sampleDirection(const image::Image& picture, math::dvec3 direction);

/// Half as wide and high, down to 1 (rounded down); each texel the mean of those it covers, by
/// solid angle.
[[nodiscard]] image::Image halve(const image::Image& picture);

/// The picture and its halves, down to a width of at most `least`.
[[nodiscard]] std::vector<image::Image> makePyramid(image::Image picture, uint32_t least);

/// Samples a pyramid between two of its levels. \param level 0: the first; clamped to those there
[[nodiscard]] math::vec3
samplePyramid(const std::vector<image::Image>& pyramid, math::dvec3 direction, double level);

/// An equirectangular picture of `width` by `width / 2` from the six sides of a cube, +X -X +Y -Y
/// +Z -Z, each as it is seen from inside the cube with +Y up (-Z at the top of +Y, +Z at the top of
/// -Y): what EXT_lights_image_based stores, OpenGL's cube maps flipped about their vertical axis.
/// \param sides square, of one size and at least three channels (CHECKed)
[[nodiscard]] image::Image unwrapCube(const std::array<image::Image, 6>& sides, uint32_t width);

} // namespace shutter::environment
