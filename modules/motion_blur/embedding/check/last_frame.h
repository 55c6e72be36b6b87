// SPDX-License-Identifier: MIT
// Lookup of the last frame's depth and ids at the former places of this frame's surfaces. Included
// only by the checks' sources.
#pragma once

#include "engine/math/math.h"
#include "modules/motion_blur/embedding/check/checked_frame.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace shutter::motion_blur {

enum class Match : uint8_t { Unknown, Same, Other };

/// The fine grid of a frame (check_grid.glsl).
class FineGrid {
  public:
    explicit FineGrid(const CheckedFrame& frame);

    /// The four cells around a place, and its share of the way to the right and lower ones.
    struct Corners {
        std::array<size_t, 4> cells; ///< upper left, upper right, lower left, lower right
        math::dvec2 share{0.0};
        math::dvec2 spacingPx{1.0};
    };

    /// Nothing: the place is not among the cells' middles.
    [[nodiscard]] std::optional<Corners> find(const math::dvec2& place) const;

    /// The id that all around the place have; nothing: they differ.
    [[nodiscard]] std::optional<uint32_t> findId(const math::dvec2& place) const;

  private:
    const CheckedFrame& mFrame;
    std::vector<double> mColumns; ///< their pixels' middles
    std::vector<double> mRows;
};

/// Depth of a frame, decoded by the host's declarations.
class FineDepth {
  public:
    /// \param declared the declarations for `frame`
    FineDepth(const CheckedFrame& frame, const CheckFacts& declared);

    /// Whether the surface that is seen at the place has that depth: to a pixel, or two percent.
    [[nodiscard]] Match compare(const math::dvec2& place, double metres) const;

    /// Whether the surface at the place is at about that depth: within a tenth, and not behind it.
    [[nodiscard]] bool isNear(const math::dvec2& place, double metres) const;

    [[nodiscard]] const FineGrid& grid() const { return mGrid; }

  private:
    FineGrid mGrid;
    /// A value that is linear across a plane in the picture: depth, or inverse depth in
    /// perspective.
    std::vector<double> mLinear;
    bool mIsPerspective = true;
};

} // namespace shutter::motion_blur
