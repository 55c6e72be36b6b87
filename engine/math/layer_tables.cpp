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

/// A parallax below this is a rounding error, pixels * metres or pixels / metre.
constexpr float kLeastParallax = 1.0e-6f;

/// Greatest parallax in the picture's corners under one affine map, pixels * metres or pixels /
/// metre.
float findParallax(const shader::InstantMotion& motion, const vec2& sizePx, bool isPerspective) {
    const auto& rows = motion.instantFromRaster;
    if (rows[2] == vec4(0.0f))
        return 0.0f;
    if (!isPerspective)
        return glm::length(vec2(rows[0].z, rows[1].z));
    const vec3 perAlong(rows[0].w, rows[1].w, rows[2].w);
    float greatest = 0.0f;
    for (const vec2 corner : {vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(1, 1)}) {
        const vec3 at(corner * sizePx, 1.0f);
        const vec3 farAway(
            glm::dot(vec3(rows[0]), at), glm::dot(vec3(rows[1]), at), glm::dot(vec3(rows[2]), at)
        );
        if (farAway.z <= 0.0f)
            continue; // behind the camera by then
        const vec2 place = vec2(farAway) / farAway.z;
        const vec2 way = vec2(perAlong) - place * perAlong.z;
        greatest = std::max(greatest, glm::length(way) / farAway.z);
    }
    return greatest;
}

} // namespace

std::vector<float>
findParallaxes(const LayerTables& layer, const InstantLayers& exposure, const uvec2& sizePx) {
    const bool hasLens = !exposure.lens.empty();
    const size_t perMover = exposure.times.size() / (hasLens ? shader::kLensSets : 1);
    float ofLens = 0.0f;
    for (const vec4& place : exposure.lens)
        ofLens = std::max(ofLens, glm::length(vec2(place.z, place.w)));
    std::vector<float> byMover(layer.motions.size() / perMover);
    for (size_t mover = 0; mover < byMover.size(); ++mover) {
        const shader::InstantMotion* motions = &layer.motions[mover * perMover];
        float greatest = 0.0f;
        for (const size_t instant : {size_t{0}, perMover / 2, perMover - 1})
            greatest = std::max(
                greatest, findParallax(motions[instant], vec2(sizePx), exposure.isPerspective)
            );
        const float parallax = greatest + ofLens;
        byMover[mover] = std::isfinite(parallax) && parallax > kLeastParallax ? parallax : 0.0f;
    }
    byMover[shader::kSkyMover] = 0.0f; // it has no depth
    std::vector<float> byRow(layer.movers.size());
    for (size_t row = 0; row < byRow.size(); ++row)
        if (layer.movers[row] < byMover.size())
            byRow[row] = byMover[layer.movers[row]];
    return byRow;
}

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

void LayerBuilder::addFixed(size_t row) {
    mTables.movers[row] = static_cast<uint32_t>(mTables.motions.size() / mPictures.size());
    mTables.motions.insert(mTables.motions.end(), mPictures.size(), makeInstantMotion(dmat4(1.0)));
}

} // namespace shutter::math
