// SPDX-License-Identifier: MIT
#include "engine/extract/raster_record.h"

#include "engine/extract/frame_view.h"
#include "engine/math/layer_tables.h"
#include "engine/math/transform.h"
#include "engine/scene/camera.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shutter::extract {

using math::dmat4;

dmat4 pictureFromWorldAt(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    double s
) {
    const auto& camera = world.registry.get<scene::Camera>(view.camera);
    const CameraPose pose = placeCamera(motion, camera, view, s);
    const math::uvec2 sizePx(view.width, view.height);
    return math::pictureFromView(pose.clipFromView, sizePx, view.jitterPx) *
           glm::inverse(pose.worldFromView);
}

RasterRecord makeRasterRecord(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    double s
) {
    ViewRequest unjittered = view;
    unjittered.jitterPx = math::dvec2(0.0);
    RasterRecord record;
    record.seconds = view.exposure.frame().raster;
    record.camera = view.camera;
    record.width = view.width;
    record.height = view.height;
    record.pictureFromWorld = pictureFromWorldAt(world, view, motion, s);
    record.unjitteredFromWorld = pictureFromWorldAt(world, unjittered, motion, s);
    record.entities = frame.entityHandles;
    record.worldFromObject = frame.worldFromObject;
    record.deforms.assign(frame.worldFromObject.size(), false);
    for (const DeformedEntity& one : frame.deformed) {
        record.deforms[one.row] = one.changes;
        record.shapes.push_back(
            {one.row, one.mesh, one.raster, frame.entities[one.row].clipFromObjectRaster}
        );
    }
    return record;
}

std::vector<ecs::Entity> listEntities(const ExtractedFrame& frame, std::span<const uint32_t> rows) {
    std::vector<ecs::Entity> entities;
    for (const uint32_t row : rows)
        entities.push_back(frame.entityHandles[row]);
    std::sort(entities.begin(), entities.end(), [](ecs::Entity a, ecs::Entity b) {
        return a.index < b.index;
    });
    return entities;
}

bool showsTheSame(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const RasterRecord& last
) {
    const scene::ExposureInterval& exposure = view.exposure;
    if (last.camera != view.camera || last.width != view.width || last.height != view.height)
        return false;
    if (motion.isCut() || scene::isCut(world, view.camera, spanSince(last, exposure)))
        return false;
    const auto poseAt = [&](double seconds) {
        return scene::worldFromRigid(world, view.camera, seconds);
    };
    const double raster = exposure.frame().raster;
    return !scene::findsCameraCut(poseAt, last.seconds, raster, exposure.shutter.cuts);
}

bool isOfFrameBefore(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const RasterRecord& last
) {
    const scene::ExposureInterval& exposure = view.exposure;
    const double age = exposure.frame().raster - last.seconds;
    return age > 0.0 &&
           std::abs(age - exposure.frameSeconds) <= kFrameSlack * exposure.frameSeconds &&
           showsTheSame(world, view, motion, last);
}

bool isOfSameFrame(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const RasterRecord& last
) {
    if (last.camera != view.camera || last.width != view.width || last.height != view.height ||
        last.seconds != view.exposure.frame().raster)
        return false;
    ViewRequest unjittered = view;
    unjittered.jitterPx = math::dvec2(0.0);
    return last.unjitteredFromWorld ==
           pictureFromWorldAt(world, unjittered, motion, view.exposure.rasterTime);
}

std::optional<ViewRequest> makeViewBefore(
    const scene::World& world, const ViewRequest& view, const scene::ExposureMotion& motion
) {
    ViewRequest before = view;
    before.exposure = scene::computeExposureBefore(view.exposure, 1);
    RasterRecord record;
    record.seconds = before.exposure.raster;
    record.camera = view.camera;
    record.width = view.width;
    record.height = view.height;
    if (!isOfFrameBefore(world, view, motion, record))
        return std::nullopt;
    return before;
}

scene::TimeSpan spanSince(const RasterRecord& last, const scene::ExposureInterval& exposure) {
    const scene::ExposureTimes frame = exposure.frame();
    return {
        last.seconds + kFrameSlack * exposure.frameSeconds, std::max(frame.raster, frame.close)};
}

std::vector<uint32_t>
findRows(const RasterRecord& record, const std::vector<ecs::Entity>& entities) {
    std::vector<uint32_t> rows(record.entities.size(), kNoRow);
    if (record.entities == entities) {
        for (uint32_t row = 0; row < rows.size(); ++row)
            rows[row] = row;
        return rows;
    }
    std::vector<uint32_t> rowOfEntity;
    for (uint32_t row = 0; row < entities.size(); ++row) {
        const uint32_t index = entities[row].index;
        if (index >= rowOfEntity.size())
            rowOfEntity.resize(index + size_t{1}, kNoRow);
        rowOfEntity[index] = row;
    }
    for (size_t row = 0; row < rows.size(); ++row) {
        const uint32_t index = record.entities[row].index;
        const uint32_t found = index < rowOfEntity.size() ? rowOfEntity[index] : kNoRow;
        if (found != kNoRow && entities[found] == record.entities[row])
            rows[row] = found;
    }
    return rows;
}

} // namespace shutter::extract
