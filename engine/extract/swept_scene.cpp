// SPDX-License-Identifier: MIT
#include "engine/extract/swept_scene.h"

#include "engine/extract/frame_view.h"
#include "engine/extract/raster_record.h"

#include <algorithm>
#include <cmath>

namespace shutter::extract {

namespace {

using math::dmat4;
using math::dvec2;
using math::dvec4;

constexpr double kFar = std::numeric_limits<double>::infinity();

constexpr double kSweptMarginPx = 2.0;
/// Above this count, movers are not tested one by one.
constexpr size_t kMaxSweptMovers = 64;
/// Nearest depth at which a box has corners in the picture, metres.
constexpr double kMinBoxDepth = 1.0e-4;

/// How far a vertex of a shape goes at most from shutter open to close in its own space, to within
/// a factor of two, metres.
double measureDeformation(const DeformedEntity& shape) {
    double tolerance = measureRounding(shape.bounds);
    for (int doublings = 0; doublings < 64; ++doublings, tolerance *= 2.0)
        if (isNear(shape.open, shape.close, *shape.reach, tolerance))
            return doublings == 0 ? 0.0 : tolerance;
    return kFar;
}

/// Pixels that a metre across the line of sight is long at a depth of a metre, or at any before an
/// orthographic camera. \param picture picture space from the world
double measureFocalLength(const dmat4& picture) {
    const dmat4 rows = glm::transpose(picture);
    const math::dvec3 forward(rows[2]);
    const math::dvec3 across(rows[0]);
    return glm::length(across - forward * glm::dot(across, forward));
}

} // namespace

math::Bounds
findExposureBounds(const ExtractedFrame& frame, const SceneLayout& layout, uint32_t row) {
    const DeformedEntity* const shape = findDeformed(frame, row);
    math::Bounds bounds = findRowBounds(frame, layout, row);
    if (shape && shape->changes)
        for (const scene::Deformation* pose : {&shape->open, &shape->close})
            bounds.add(scene::computeDeformedBounds(*shape->reach, *pose));
    return bounds;
}

void SweptBox::spread() {
    least = dvec2(-kFar);
    most = dvec2(kFar);
    wayPx = kFar;
}

bool overlap(const SweptBox& a, const SweptBox& b) {
    return a.least.x <= b.most.x && b.least.x <= a.most.x && a.least.y <= b.most.y &&
           b.least.y <= a.most.y;
}

SweptScene::SweptScene(const SweptSource& source)
    : SweptSource(source),
      isPerspective(
          world.registry.get<scene::Camera>(view.camera).kind == scene::CameraKind::Perspective
      ) {
    for (size_t i = 0; i < kTimes; ++i) {
        mTimes[i] = double(i) / double(kTimes - 1);
        mPictures[i] = pictureFromWorldAt(world, view, motion, mTimes[i]);
        cameraMoves = cameraMoves || mPictures[i] != mPictures[0];
        if (!hasLens || !isPerspective)
            continue;
        const math::ThinLens lens =
            describeLens(motion, world.registry.get<scene::Camera>(view.camera), view, mTimes[i]);
        const double squeeze = std::max(double(lens.aperture.squeeze), 1.0);
        mLenses[i] = {lens.radius * squeeze * lens.pixelsPerUnit.y, 1.0 / lens.focusDistance};
        mIsLensOpen = mIsLensOpen || lens.radius > 0.0;
    }
}

double SweptScene::measureParallax(const dvec4& nearer, const dvec4& beyond) const {
    double parallax = 0.0;
    for (size_t i = 0; i < kTimes; ++i) {
        const dvec4 a = mPictures[i] * nearer;
        const dvec4 b = mPictures[i] * beyond;
        const dvec2 q = isPerspective ? dvec2(a.z, b.z) : dvec2(1.0);
        // Written so that NaN is not known, too.
        if (!(q.x > kMinBoxDepth && q.y > 0.0))
            return kFar;
        const double lens = mLenses[i].x * std::abs(nearer.w / q.x - beyond.w / q.y);
        parallax = std::max(parallax, glm::distance(dvec2(a) / q.x, dvec2(b) / q.y) + lens);
    }
    return parallax;
}

bool SweptScene::moves(uint32_t row) const {
    const DeformedEntity* const shape = findDeformed(frame, row);
    return motion.mayObjectMove(frame.entityHandles[row]) || (shape && shape->changes);
}

bool SweptScene::hasGeometry(uint32_t row, bool isBlended) const {
    const uint32_t mesh = frame.entityMeshes[row];
    for (uint32_t i = layout.firstGeometry[mesh]; i < layout.firstGeometry[mesh + 1]; ++i)
        if ((layout.geometries[i].alphaMode == scene::AlphaMode::Blend) == isBlended)
            return true;
    return false;
}

SweptBox SweptScene::sweep(uint32_t row) const {
    const DeformedEntity* const shape = findDeformed(frame, row);
    const math::Bounds bounds = findExposureBounds(frame, layout, row);
    const ecs::Entity entity = frame.entityHandles[row];
    const bool isStatic = !motion.mayObjectMove(entity);
    SweptBox box;
    std::array<dvec2, 8> before{};
    std::array<double, 8> ways{};
    double spreads = 0.0;
    bool isEverywhere = false;
    for (size_t i = 0; i < kTimes; ++i) {
        const dmat4 picture = mPictures[i] * (isStatic ? frame.worldFromObject[row]
                                                       : motion.worldFromObject(entity, mTimes[i]));
        for (size_t corner = 0; corner < 8; ++corner) {
            const dvec4 at = picture * dvec4(
                                           corner & 1 ? bounds.max.x : bounds.min.x,
                                           corner & 2 ? bounds.max.y : bounds.min.y,
                                           corner & 4 ? bounds.max.z : bounds.min.z,
                                           1.0
                                       );
            const double q = isPerspective ? at.z : 1.0;
            box.nearest = std::min(box.nearest, at.z);
            box.farthest = std::max(box.farthest, at.z);
            // Written so that NaN is everywhere, too.
            if (!(q > kMinBoxDepth)) {
                isEverywhere = true;
                continue;
            }
            const dvec2 place = dvec2(at) / q;
            if (i > 0)
                ways[corner] += glm::distance(place, before[corner]);
            before[corner] = place;
            const double spread = mLenses[i].x * std::abs(mLenses[i].y - 1.0 / q);
            spreads = std::max(spreads, 2.0 * spread);
            box.least = glm::min(box.least, place - (kSweptMarginPx + spread));
            box.most = glm::max(box.most, place + (kSweptMarginPx + spread));
        }
    }
    box.wayPx = *std::max_element(ways.begin(), ways.end()) + spreads;
    if (shape && shape->changes) {
        const double depth = isPerspective ? std::max(box.nearest, kMinBoxDepth) : 1.0;
        box.wayPx += measureDeformation(*shape) * measureFocalLength(mPictures[0]) / depth;
    }
    if (isEverywhere)
        box.spread();
    return box;
}

bool SweptScene::isInPicture(const SweptBox& box) const {
    return (!isPerspective || box.farthest > 0.0) && box.least.x < double(view.width) &&
           box.most.x > 0.0 && box.least.y < double(view.height) && box.most.y > 0.0;
}

std::optional<std::vector<SweptBox>> SweptScene::sweepOpaqueMovers() const {
    std::vector<SweptBox> boxes;
    for (const uint32_t row : frame.movingRows)
        if (moves(row) && hasGeometry(row, false) && !addBox(row, boxes))
            return std::nullopt;
    return boxes;
}

std::optional<std::vector<SweptBox>> SweptScene::sweepOpaque() const {
    std::vector<SweptBox> boxes;
    for (const auto* draws : {&frame.opaque.still, &frame.opaque.moving})
        for (const DrawItem& item : *draws)
            if (!addBox(item.entity, boxes))
                return std::nullopt;
    return boxes;
}

bool SweptScene::addBox(uint32_t row, std::vector<SweptBox>& boxes) const {
    const SweptBox box = sweep(row);
    if (isInPicture(box))
        boxes.push_back(box);
    return boxes.size() <= kMaxSweptMovers;
}

} // namespace shutter::extract
