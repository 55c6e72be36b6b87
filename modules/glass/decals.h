// SPDX-License-Identifier: MIT
// Which static blended surfaces move in the picture as their background does: decals on opaque
// surfaces, and whatever the camera and its lens see without parallax.
#pragma once

#include "engine/extract/swept_scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shutter::glass {

class DecalSearch {
  public:
    /// \param scene must outlive this
    explicit DecalSearch(const extract::SweptScene& scene);

    /// Whether the static row's blended surfaces are seen within half a pixel of their background
    /// at all instants and from all places of the lens, as far as points of them show. False where
    /// that takes too many triangles to find out.
    [[nodiscard]] bool movesWithBackground(uint32_t row);

  private:
    /// A static row with opaque surfaces, and a sphere around it in the world.
    struct Ground {
        uint32_t row = 0;
        math::dvec3 centre{0.0};
        double radius = 0.0; ///< metres
    };

    void listGrounds();
    /// Middles of some of the row's blended triangles, in the world: in the picture, if any are.
    [[nodiscard]] std::vector<math::dvec3> listPoints(uint32_t row) const;
    bool isOnGround(const math::dvec3& point);
    bool meets(uint32_t row, const math::dvec3& from, const math::dvec3& to);

    const extract::SweptScene& mScene;
    math::dmat4 mPicture{1.0}; ///< picture space of the raster, from the world
    math::dvec3 mEye{0.0};
    math::dvec3 mForward{0.0};
    bool mIsListed = false;
    std::vector<Ground> mGrounds;
    size_t mTested = 0; ///< triangles
};

} // namespace shutter::glass
