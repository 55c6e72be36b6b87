// SPDX-License-Identifier: MIT
#include "engine/math/layer_tables.h"

#include "engine/core/check.h"
#include "engine/math/transform.h"

#include <algorithm>
#include <cmath>

namespace shutter::math {

namespace {

/// Places have no meaning for the sky: only directions.
dmat4 withoutTranslation(const dmat4& matrix) {
    dmat4 result = matrix;
    result[3] = dvec4(0.0, 0.0, 0.0, 1.0);
    return result;
}

} // namespace

dmat4 pictureFromView(const dmat4& clipFromView, const uvec2& sizePx, const dvec2& jitterPx) {
    const dmat4 rows = glm::transpose(clipFromView);
    const dvec2 size(sizePx);
    dmat4 picture(0.0); // its rows
    for (int axis = 0; axis < 2; ++axis)
        picture[axis] = 0.5 * size[axis] * (rows[axis] + rows[3]) - jitterPx[axis] * rows[3];
    picture[2] = dvec4(0.0, 0.0, -1.0, 0.0);
    picture[3] = dvec4(0.0, 0.0, 0.0, 1.0);
    return glm::transpose(picture);
}

shader::InstantMotion makeInstantMotion(const dmat4& instantFromRaster) {
    shader::InstantMotion motion{};
    const dmat4 inverse = glm::inverse(instantFromRaster);
    if (!isFinite(instantFromRaster) || !isFinite(inverse))
        return motion;
    bool fits = true;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            motion.instantFromRaster[row][column] = float(instantFromRaster[column][row]);
            motion.rasterFromInstant[row][column] = float(inverse[column][row]);
            fits = fits && std::isfinite(motion.instantFromRaster[row][column]) &&
                   std::isfinite(motion.rasterFromInstant[row][column]);
        }
    return fits ? motion : shader::InstantMotion{};
}

LayerBuilder::LayerBuilder(
    const dmat4& layerPicture, std::span<const dmat4> pictures, bool isPerspective, size_t rowCount
)
    : mLayerPicture(layerPicture), mPictures(pictures) {
    SHUTTER_CHECK(!pictures.empty(), "no instants");
    mTables.movers.assign(rowCount + 1, shader::kWorldMover);
    mTables.movers[rowCount] = shader::kSkyMover;
    mTables.isStatic = std::all_of(pictures.begin(), pictures.end(), [&](const dmat4& picture) {
        return picture == layerPicture;
    });
    const dmat4 worldFromLayer = glm::inverse(layerPicture);
    for (const dmat4& picture : pictures)
        mTables.motions.push_back(makeInstantMotion(picture * worldFromLayer));
    const dmat4 skyFromLayer = glm::inverse(withoutTranslation(layerPicture));
    for (const dmat4& picture : pictures)
        mTables.motions.push_back(makeInstantMotion(
            isPerspective ? withoutTranslation(picture) * skyFromLayer : dmat4(1.0)
        ));
}

} // namespace shutter::math
