// SPDX-License-Identifier: MIT
#include "engine/extract/reprojection.h"

#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"

#include <array>

namespace shutter::extract {

namespace {

using math::dmat4;

bool mayUse(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const RasterRecord& last
) {
    const double age = view.exposure.frame().raster - last.seconds;
    // Frames without a duration, as while time is paused, may still follow a frame with one.
    const double most = kMostFramesAgo * (view.exposure.frameSeconds + scene::kStillFrameSeconds);
    return age >= 0.0 && age <= most && showsTheSame(world, view, motion, last);
}

/// By row of this frame: the same entity's row of the last one, or kNoRow.
std::vector<uint32_t> findLastRows(const RasterRecord& last, const RasterRecord& now) {
    const std::vector<uint32_t> nowRows = findRows(last, now.entities);
    std::vector<uint32_t> rows(now.entities.size(), kNoRow);
    for (uint32_t row = 0; row < nowRows.size(); ++row)
        if (nowRows[row] != kNoRow)
            rows[nowRows[row]] = row;
    return rows;
}

} // namespace

Reprojection computeReprojection(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    const RasterRecord* last
) {
    ViewRequest unjittered = view;
    unjittered.jitterPx = math::dvec2(0.0);
    Reprojection result;
    result.isPerspective =
        world.registry.get<scene::Camera>(view.camera).kind == scene::CameraKind::Perspective;
    result.record = makeRasterRecord(world, unjittered, motion, frame, view.exposure.rasterTime);
    const RasterRecord& now = result.record;
    if (!last || !mayUse(world, view, motion, *last))
        return result;
    result.ageSeconds = now.seconds - last->seconds;
    const scene::TimeSpan span = spanSince(*last, view.exposure);
    const std::array pictures{last->pictureFromWorld};
    math::LayerBuilder layer(
        now.pictureFromWorld, pictures, result.isPerspective, now.entities.size()
    );
    const std::vector<uint32_t> lastRows = findLastRows(*last, now);
    for (size_t row = 0; row < lastRows.size(); ++row) {
        const uint32_t before = lastRows[row];
        if (before == kNoRow) {
            layer.setMover(row, shader::kNoMover);
            continue;
        }
        const dmat4& worldFromObject = last->worldFromObject[before];
        const bool wasMoved = worldFromObject != now.worldFromObject[row];
        const bool wasDeformed = now.deforms[row] && result.ageSeconds > 0.0;
        if (!wasMoved && !wasDeformed)
            continue;
        if (scene::hasNoPast(world, now.entities[row], span))
            layer.setMover(row, shader::kNoMover);
        else if (wasDeformed)
            layer.setMover(row, shader::kDeformedMover);
        else
            layer.addMover(row, now.worldFromObject[row], [&](size_t) { return worldFromObject; });
    }
    result.last = layer.take();
    return result;
}

} // namespace shutter::extract
