// SPDX-License-Identifier: MIT
// Motion of the surfaces in raster images over the instants of an exposure: affine maps between
// picture spaces (shaders/common/instant_motion_shared.h), per mover. A world of entities and a
// host engine both build these tables.
#pragma once

#include "engine/math/math.h"
#include "shaders/common/instant_motion_shared.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace shutter::math {

/// The movers of one raster and their motion over the exposure.
struct LayerTables {
    std::vector<uint32_t> movers; ///< by row of the raster's entity table, and one for the sky
    /// For each mover one per instant, or with a lens per sample (LayerMotion::motions).
    std::vector<shader::InstantMotion> motions;
    /// By row of the raster's entity table: the same entity's row in this frame's raster, or
    /// shader::kNoRasterRow; empty for this frame's raster itself.
    std::vector<uint32_t> rasterRows;
    /// Static entities have the same place in the picture at every instant, as in the raster.
    bool isStatic = false;
    bool deforms = false; ///< a mover is shader::kDeformedMover
};

/// Tables of a frame's rasters and of the previous frame's.
struct InstantLayers {
    LayerTables raster;
    std::optional<LayerTables> second; ///< raster at the exposure's other end; nothing: there is
                                       ///< none
    std::optional<LayerTables> last;   ///< nothing: the last raster is not usable for this frame
    std::vector<float> times;          ///< shutter time of each instant, [0, 1]
    std::vector<vec4> lens;            ///< InstantMotions::lens; empty: there is none
    std::vector<shader::LensReach> lensReaches; ///< InstantMotions::lensReaches; the same
    std::vector<vec2> lensPlaces;               ///< InstantMotions::lensPlaces; the same
    vec2 confusion{0.0f};                       ///< InstantMotions::confusion
    vec4 aperture{0, 0, 0, 1};                  ///< InstantMotions::aperture; a disc
    bool isPerspective = true; ///< the camera is, at every instant; false: orthographic
};

/// Picture space from a view space with -Z forward.
/// \param clipFromView perspective with a clip w of -z, or orthographic with one of 1; y down
/// \param jitterPx of the raster, right and down; subtracted from positions
[[nodiscard]] dmat4
pictureFromView(const dmat4& clipFromView, const uvec2& sizePx, const dvec2& jitterPx);

/// Makes both maps between a raster's picture space and an instant's; all zeros if the map is
/// singular or exceeds the range of single precision.
[[nodiscard]] shader::InstantMotion makeInstantMotion(const dmat4& instantFromRaster);

/// Computes LayerMotion::parallaxes, one per row of the layer's entity table and one for the sky:
/// the greatest of each mover in the picture's corners at the first, middle and last instant, plus
/// the reach of the lens where there is one. \param layer one of the exposure's
[[nodiscard]] std::vector<float>
findParallaxes(const LayerTables& layer, const InstantLayers& exposure, const uvec2& sizePx);

/// Builds the tables of one layer. To begin with, all rows are static in the world.
class LayerBuilder {
  public:
    /// \param layerPicture picture space from the world when the layer was drawn
    /// \param pictures the same for each instant; at least one, and they must outlive this
    /// \param rowCount of the layer's entity table
    LayerBuilder(
        const dmat4& layerPicture,
        std::span<const dmat4> pictures,
        bool isPerspective,
        size_t rowCount
    );

    /// A row that moves rigidly.
    /// \param worldFromObject when the layer was drawn
    /// \param worldFromObjectAt (size_t instant) -> dmat4, at each instant
    template <class At>
    void addMover(size_t row, const dmat4& worldFromObject, const At& worldFromObjectAt) {
        addPicture(row, mLayerPicture * worldFromObject, [&](size_t i) {
            return mPictures[i] * worldFromObjectAt(i);
        });
    }

    /// The same for a row with a projection of its own.
    /// \param pictureFromObject when the layer was drawn
    /// \param pictureFromObjectAt (size_t instant) -> dmat4, at each instant
    template <class At>
    void addPicture(size_t row, const dmat4& pictureFromObject, const At& pictureFromObjectAt) {
        mTables.movers[row] = static_cast<uint32_t>(mTables.motions.size() / mPictures.size());
        const dmat4 objectFromLayer = glm::inverse(pictureFromObject);
        for (size_t i = 0; i < mPictures.size(); ++i)
            mTables.motions.push_back(makeInstantMotion(pictureFromObjectAt(i) * objectFromLayer));
    }

    /// A row that has the same place in the picture at every instant, whatever the camera does.
    void addFixed(size_t row);

    /// \param kind shader::kDeformedMover or shader::kNoMover
    void setMover(size_t row, uint32_t kind) {
        mTables.movers[row] = kind;
        mTables.deforms = mTables.deforms || kind == shader::kDeformedMover;
    }

    /// \param rows by row of the layer's entity table: the row in this frame's, or kNoRasterRow
    void setRasterRows(std::vector<uint32_t> rows) { mTables.rasterRows = std::move(rows); }

    [[nodiscard]] LayerTables take() { return std::move(mTables); }

  private:
    dmat4 mLayerPicture;
    std::span<const dmat4> mPictures;
    LayerTables mTables;
};

} // namespace shutter::math
