// SPDX-License-Identifier: MIT
#include "engine/render/backdrop.h"

#include "engine/math/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace shutter::render {

namespace {

/// More movers than these are not looked at one by one.
constexpr size_t kMostMovers = 64;

/// Where an entity is in the picture.
struct ScreenBox {
    uint32_t row = 0;
    double least[2] = {-1.0, -1.0}; ///< normalised device coordinates
    double most[2] = {1.0, 1.0};
    double nearest = 0.0; ///< metres along the view
    double farthest = std::numeric_limits<double>::infinity();
};

const math::Bounds& boundsOf(const ExtractedFrame& frame, const SceneLayout& layout, uint32_t row) {
    const auto bent = std::lower_bound(
        frame.deformed.begin(),
        frame.deformed.end(),
        row,
        [](const DeformedEntity& entity, uint32_t wanted) { return entity.row < wanted; }
    );
    if (bent != frame.deformed.end() && bent->row == row)
        return bent->bounds;
    return layout.bounds[frame.entityMeshes[row]];
}

/// The whole picture where a corner lies before the near plane.
ScreenBox findBox(const ExtractedFrame& frame, const SceneLayout& layout, uint32_t row) {
    const shader::EntityRow& entity = frame.entities[row];
    const math::Bounds& bounds = boundsOf(frame, layout, row);
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
            glm::dot(entity.eyeFromObject[0], point),
            glm::dot(entity.eyeFromObject[1], point),
            glm::dot(entity.eyeFromObject[2], point)
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
    if (crossesNear)
        return {row, {-1.0, -1.0}, {1.0, 1.0}, box.nearest, box.farthest};
    for (int axis = 0; axis < 2; ++axis) {
        box.least[axis] = std::max(box.least[axis], -1.0);
        box.most[axis] = std::min(box.most[axis], 1.0);
    }
    return box;
}

/// Written so that what is no number overlaps.
bool liesBehind(const ScreenBox& box, const ScreenBox& mover) {
    if (box.row == mover.row || box.farthest < mover.nearest)
        return false;
    for (int axis = 0; axis < 2; ++axis)
        if (box.most[axis] < mover.least[axis] || mover.most[axis] < box.least[axis])
            return false;
    return true;
}

/// Rows that are drawn, far to near, without the blended ones.
std::vector<uint32_t> listDrawn(const ExtractedFrame& frame) {
    std::vector<uint32_t> rows;
    const auto append = [&](const std::vector<DrawItem>& items) {
        for (auto item = items.rbegin(); item != items.rend(); ++item)
            if (rows.empty() || rows.back() != item->entity)
                rows.push_back(item->entity);
    };
    append(frame.opaque.still);
    append(frame.opaque.moving);
    return rows;
}

} // namespace

Decision decideReveal(const ExtractedFrame& frame, const SceneLayout& layout) {
    if (!frame.blended.empty())
        return {true, "blended surfaces may lie before or behind what moves"};
    const std::vector<uint32_t> drawn = listDrawn(frame);
    std::vector<ScreenBox> movers;
    for (const uint32_t row : drawn) {
        if (frame.entities[row].motion == shader::kNoMotion)
            continue;
        if (movers.size() == kMostMovers)
            return {true, fmt::format("more than {} entities move in the picture", kMostMovers)};
        movers.push_back(findBox(frame, layout, row));
    }
    for (const uint32_t row : drawn) {
        const ScreenBox box = findBox(frame, layout, row);
        if (std::any_of(movers.begin(), movers.end(), [&](const ScreenBox& mover) {
                return liesBehind(box, mover);
            }))
            return {true, "surfaces may come into sight behind what moves"};
    }
    return {false, "nothing but sky lies behind what moves"};
}

} // namespace shutter::render
