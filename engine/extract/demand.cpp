// SPDX-License-Identifier: MIT
#include "engine/extract/demand.h"

#include "engine/core/words.h"
#include "engine/extract/extracted_frame.h"
#include "engine/math/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

namespace shutter::extract {

namespace {

/// Above this count, movers are not tested one by one.
constexpr size_t kMaxMovers = 64;

constexpr double kMarginPx = 1.0;

/// Where an entity is in the picture.
struct ScreenBox {
    uint32_t row = 0;
    double least[2] = {-1.0, -1.0}; ///< normalised device coordinates
    double most[2] = {1.0, 1.0};
    double nearest = 0.0; ///< metres along the view
    double farthest = std::numeric_limits<double>::infinity();
};

/// The whole picture where a corner lies before the near plane.
ScreenBox findBox(const ExtractedFrame& frame, const SceneLayout& layout, uint32_t row) {
    const shader::EntityRow& entity = frame.entities[row];
    const math::Bounds& bounds = findRowBounds(frame, layout, row);
    const math::vec4 forward = frame.constants.forward;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    ScreenBox box{row, {kInfinity, kInfinity}, {-kInfinity, -kInfinity}, kInfinity, -kInfinity};
    bool crossesNear = false;
    for (int corner = 0; corner < 8; ++corner) {
        const math::vec4 point(
            corner & 1 ? bounds.max.x : bounds.min.x,
            corner & 2 ? bounds.max.y : bounds.min.y,
            corner & 4 ? bounds.max.z : bounds.min.z,
            1.0
        );
        const math::vec4 clip = entity.clipFromObjectRaster * point;
        const math::vec3 eye(
            glm::dot(entity.relWorldFromObject[0], point),
            glm::dot(entity.relWorldFromObject[1], point),
            glm::dot(entity.relWorldFromObject[2], point)
        );
        const double depth = glm::dot(eye, math::vec3(forward));
        box.nearest = std::min(box.nearest, depth);
        box.farthest = std::max(box.farthest, depth);
        crossesNear = crossesNear || !(clip.w >= forward.w);
        for (int axis = 0; axis < 2; ++axis) {
            box.least[axis] = std::min(box.least[axis], double(clip[axis]) / double(clip.w));
            box.most[axis] = std::max(box.most[axis], double(clip[axis]) / double(clip.w));
        }
    }
    // Boxes that cross the near plane or contain NaN may be anywhere.
    if (!(box.nearest <= box.farthest))
        return {row, {-1.0, -1.0}, {1.0, 1.0}, -kInfinity, kInfinity};
    if (crossesNear || !(box.least[0] <= box.most[0]) || !(box.least[1] <= box.most[1]))
        return {row, {-1.0, -1.0}, {1.0, 1.0}, box.nearest, box.farthest};
    for (int axis = 0; axis < 2; ++axis) {
        // Raster moves corners to a grid, and covers pixels by their centres.
        const double margin = 2.0 * kMarginPx / double(frame.constants.sizePx[axis]);
        box.least[axis] = std::max(box.least[axis] - margin, -1.0);
        box.most[axis] = std::min(box.most[axis] + margin, 1.0);
    }
    return box;
}

bool liesBehind(const ScreenBox& box, const ScreenBox& mover) {
    if (box.row == mover.row || box.farthest < mover.nearest)
        return false;
    for (int axis = 0; axis < 2; ++axis)
        if (box.most[axis] < mover.least[axis] || mover.most[axis] < box.least[axis])
            return false;
    return true;
}

/// Calls `visit` with each row of a list of draws, far to near, until it returns true.
template <class Visit> bool visitRows(const std::vector<DrawItem>& draws, Visit&& visit) {
    for (auto item = draws.rbegin(); item != draws.rend(); ++item) {
        const bool again = item != draws.rbegin() && std::prev(item)->entity == item->entity;
        if (!again && visit(item->entity))
            return true;
    }
    return false;
}

} // namespace

core::Decision decideReveal(const ExtractedFrame& frame, const SceneLayout& layout) {
    if (!frame.blended.empty())
        return {true, "blended surfaces may lie before or behind movers"};
    std::vector<ScreenBox> movers;
    const auto addMover = [&](uint32_t row) {
        if (frame.entities[row].motion != shader::kNoMotion)
            movers.push_back(findBox(frame, layout, row));
        return movers.size() > kMaxMovers;
    };
    const bool cameraMoves = !frame.staticMotions.empty();
    if (visitRows(frame.opaque.moving, addMover) ||
        (cameraMoves && visitRows(frame.opaque.still, addMover)))
        return {true, fmt::format("more than {} entities move in the picture", kMaxMovers)};
    if (!movers.empty() && (frame.constants.flags & shader::kFrameEnvironment) != 0)
        return {true, "an environment comes into sight behind movers"};
    const auto isRevealed = [&](uint32_t row) {
        const ScreenBox box = findBox(frame, layout, row);
        return std::any_of(movers.begin(), movers.end(), [&](const ScreenBox& mover) {
            return liesBehind(box, mover);
        });
    };
    if (visitRows(frame.opaque.still, isRevealed) || visitRows(frame.opaque.moving, isRevealed))
        return {true, "surfaces may come into sight behind movers"};
    return {false, "nothing but sky lies behind movers"};
}

SurfaceDemand decideSurfaces(const ExtractedFrame& frame) {
    size_t masked = 0;
    frame.opaque.forEach([&](const DrawItem& draw) {
        masked += draw.alphaMode == scene::AlphaMode::Mask;
    });
    SurfaceDemand demand;
    demand.deformation = {false, "no mesh that is drawn has a skin, morph targets or waves"};
    if (!frame.deformed.empty())
        demand.deformation = {
            true,
            core::countOf(frame.deformed.size(), "drawn entity", "drawn entities") +
                " with a skin, morph targets or waves"};
    demand.alphaMask = {false, "no surface in the picture has an alpha mask"};
    if (masked > 0)
        demand.alphaMask = {
            true, core::countOf(masked, "draw") + " in the picture with an alpha mask"};
    demand.blending = {false, "no surface in the picture is blended"};
    if (!frame.blended.empty())
        demand.blending = {
            true, core::countOf(frame.blended.size(), "blended draw") + " in the picture"};
    return demand;
}

} // namespace shutter::extract
