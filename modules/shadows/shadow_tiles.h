// SPDX-License-Identifier: MIT
// Where in a picture the shadows of movers may fall, found from boxes. Pure, in world space.
#pragma once

#include "engine/math/bounds.h"
#include "engine/math/math.h"
#include "modules/shadows/shadow_casters.h"
#include "modules/shadows/shadow_views.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace shutter::shadows {

/// The picture that receives the shadows.
struct ShadowPicture {
    math::dmat4 clipFromWorld{1.0};
    math::uvec2 sizePx{0};
    math::Bounds scene; ///< holds all that receives shadows, metres
    math::dvec3 eye{0.0};
    math::dvec2 pixelFootprint{0.0}; ///< shader::FrameConstants'
};

/// A rectangle of pixels.
struct PixelBox {
    math::dvec2 min{0.0}; ///< from the picture's corner, pixels; may lie outside of it
    math::dvec2 max{0.0};
};

/// Contains every point of the picture from which the ray to the light may hit the caster.
/// \param caster over the exposure
/// \return nothing: it may be anywhere
[[nodiscard]] std::optional<PixelBox>
boundShadow(const ShadowPicture& picture, const Sphere& caster, const LightPlace& light);

/// Width of the caster, pixels, where the camera is nearest to its shadow or to itself: no texel of
/// its layer need be much finer than a pixel there.
/// \param toLight unit, of a light that is far away
[[nodiscard]] double
findShadowWidth(const ShadowPicture& picture, const Sphere& caster, const math::dvec3& toLight);

/// A bit for each mover in each tile of a picture.
class ShadowTiles {
  public:
    explicit ShadowTiles(const math::uvec2& sizePx);

    /// Marks the tiles that a box touches. \param box nothing: all of them
    void mark(uint32_t mover, const std::optional<PixelBox>& box);

    [[nodiscard]] uint32_t across() const { return mAcross; }

    /// In rows of across(), the top row first.
    [[nodiscard]] const std::vector<uint32_t>& movers() const { return mMovers; }

  private:
    uint32_t mAcross;
    uint32_t mDown;
    std::vector<uint32_t> mMovers;
};

} // namespace shutter::shadows
