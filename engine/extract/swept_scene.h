// SPDX-License-Identifier: MIT
// Where entities are in the picture in the course of an exposure, as boxes.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/math/math.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/world.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace shutter::extract {

/// Object space: of a row's mesh as it is when the shutter opens and closes and at the raster
/// instant.
[[nodiscard]] math::Bounds
findExposureBounds(const ExtractedFrame& frame, const SceneLayout& layout, uint32_t row);

/// Where an entity is in the picture in the course of the exposure.
struct SweptBox {
    math::dvec2 least{std::numeric_limits<double>::infinity()}; ///< pixels
    math::dvec2 most{-std::numeric_limits<double>::infinity()};
    double nearest = std::numeric_limits<double>::infinity(); ///< metres along the view
    double farthest = -std::numeric_limits<double>::infinity();
    /// Longest, of a corner, and the width of what the lens spreads it over; infinity: not known.
    double wayPx = 0.0;

    /// Grows to the whole picture.
    void spread();
};

[[nodiscard]] bool overlap(const SweptBox& a, const SweptBox& b);

/// The scene whose boxes are swept. Referenced objects must outlive it.
struct SweptSource {
    const scene::World& world;
    const SceneLayout& layout;
    const ViewRequest& view;
    const scene::ExposureMotion& motion; ///< of the view's exposure
    const ExtractedFrame& frame;         ///< of the view
    bool hasLens = false;                ///< all places of the camera's lens see the picture
};

class SweptScene : public SweptSource {
  public:
    explicit SweptScene(const SweptSource& source);

    /// In the world, during the exposure.
    [[nodiscard]] bool moves(uint32_t row) const;
    /// Whether the row's mesh has blended surfaces, or else any others.
    [[nodiscard]] bool hasGeometry(uint32_t row, bool isBlended) const;
    [[nodiscard]] SweptBox sweep(uint32_t row) const;
    [[nodiscard]] bool isInPicture(const SweptBox& box) const;
    /// Greatest distance in the picture, pixels, that two static points which the raster shows at
    /// one place have at the same instant and place of the lens. Infinity: not known. \param beyond
    /// with w = 0 a direction, infinitely far away
    [[nodiscard]] double
    measureParallax(const math::dvec4& nearer, const math::dvec4& beyond) const;
    /// Boxes of the rows with opaque surfaces that move in the world; nullopt: more than are swept
    /// one by one.
    [[nodiscard]] std::optional<std::vector<SweptBox>> sweepOpaqueMovers() const;
    /// Boxes of all rows with opaque surfaces that the raster shows; nullopt as above.
    [[nodiscard]] std::optional<std::vector<SweptBox>> sweepOpaque() const;

    /// Whether measureParallax() is above 0 for some points.
    [[nodiscard]] bool hasParallax() const { return cameraMoves || mIsLensOpen; }

    const bool isPerspective;
    bool cameraMoves = false;

  private:
    /// Number of times at which boxes are evaluated; between them, rotating boxes exceed the hull
    /// by less than the margin.
    static constexpr size_t kTimes = 9;

    /// \return false: the limit is exceeded
    bool addBox(uint32_t row, std::vector<SweptBox>& boxes) const;

    std::array<double, kTimes> mTimes{};
    std::array<math::dmat4, kTimes> mPictures{};
    /// Half the opening's longer side, pixels from 1 m away; and 1 / the focus distance.
    std::array<math::dvec2, kTimes> mLenses{};
    bool mIsLensOpen = false;
};

} // namespace shutter::extract
