// SPDX-License-Identifier: MIT
#include "engine/extract/instant_tables.h"

#include "engine/core/check.h"
#include "engine/extract/frame_view.h"
#include "engine/math/transform.h"
#include "engine/scene/camera.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::extract {

namespace {

using math::dmat4;
using math::LayerBuilder;
using math::LayerTables;

constexpr uint32_t kNoRow = 0xFFFFFFFFu;
/// Share of a frame's duration within which two times are the same: frame times are rounded.
constexpr double kFrameSlack = 1.0e-3;

class Builder {
  public:
    Builder(
        const scene::World& world,
        const ViewRequest& view,
        const ExtractedFrame& frame,
        uint32_t instantCount
    )
        : mWorld(world), mView(view), mFrame(frame),
          mCamera(world.registry.get<scene::Camera>(view.camera)),
          mMotion(world, view.camera, view.exposure) {
        for (uint32_t i = 0; i < instantCount; ++i)
            mTimes.push_back(
                scene::invertResponse(view.exposure.shutter.response, (i + 0.5) / instantCount)
            );
        for (const double s : mTimes)
            mPictures.push_back(pictureAt(s));
        mRasterPicture = pictureAt(view.exposure.rasterTime);
    }

    InstantTables run(const RasterRecord* last, const InstantFrame* second) {
        InstantTables tables;
        tables.isPerspective = mCamera.kind == scene::CameraKind::Perspective;
        tables.times.assign(mTimes.begin(), mTimes.end());
        tables.record = makeRecord(mFrame, mView.exposure.raster, mRasterPicture);
        tables.raster = describeRaster();
        if (last && mayUse(*last))
            tables.last = describeLast(*last, tables.record);
        if (second)
            tables.second = describeSecond(
                makeRecord(
                    second->frame, mView.exposure.at(second->instant), pictureAt(second->instant)
                ),
                tables.record
            );
        return tables;
    }

  private:
    /// Picture space at shutter time s from the world.
    dmat4 pictureAt(double s) const {
        const double aspect = double(mView.width) / mView.height;
        const dmat4 clip = makeProjection(mCamera, mMotion.cameraYFov(s), aspect);
        const dmat4 worldFromView = computeWorldFromView(mMotion.worldFromCamera(s));
        const math::uvec2 sizePx(mView.width, mView.height);
        return math::pictureFromView(clip, sizePx, mView.jitterPx) * glm::inverse(worldFromView);
    }

    RasterRecord
    makeRecord(const ExtractedFrame& frame, double seconds, const dmat4& pictureFromWorld) const {
        RasterRecord record;
        record.seconds = seconds;
        record.camera = mView.camera;
        record.width = mView.width;
        record.height = mView.height;
        record.pictureFromWorld = pictureFromWorld;
        // Rows of others' making stand behind those that were drawn.
        const auto drawn = std::ptrdiff_t(frame.worldFromObject.size());
        record.entities.assign(frame.entityHandles.begin(), frame.entityHandles.begin() + drawn);
        record.worldFromObject = frame.worldFromObject;
        record.deforms.assign(frame.worldFromObject.size(), false);
        for (const DeformedEntity& one : frame.deformed)
            record.deforms[one.row] = one.changes;
        return record;
    }

    [[nodiscard]] LayerBuilder begin(const dmat4& layerPicture, size_t rows) const {
        return {layerPicture, mPictures, mCamera.kind == scene::CameraKind::Perspective, rows};
    }

    void addMover(LayerBuilder& layer, size_t row, ecs::Entity entity, const dmat4& worldFromObject)
        const {
        layer.addMover(row, worldFromObject, [&](size_t instant) {
            return mMotion.worldFromObject(entity, mTimes[instant]);
        });
    }

    LayerTables describeRaster() const {
        const size_t rows = mFrame.worldFromObject.size();
        LayerBuilder layer = begin(mRasterPicture, rows);
        const auto describe = [&](size_t row) {
            const ecs::Entity entity = mFrame.entityHandles[row];
            if (mMotion.mayObjectMove(entity))
                addMover(layer, row, entity, mFrame.worldFromObject[row]);
        };
        // What an artist's scale, or a cap, moves is static in the world.
        if (mayScaleMotion(mWorld, mView.exposure)) {
            for (size_t row = 0; row < rows; ++row)
                describe(row);
        } else {
            for (const uint32_t row : mFrame.movingRows)
                describe(row);
        }
        for (const DeformedEntity& one : mFrame.deformed)
            if (one.changes)
                layer.setMover(one.row, shader::kDeformedMover);
        return layer.take();
    }

    bool mayUse(const RasterRecord& last) const {
        const scene::ExposureInterval& exposure = mView.exposure;
        const double age = exposure.raster - last.seconds;
        if (last.camera != mView.camera || last.width != mView.width ||
            last.height != mView.height || !(age > 0.0) ||
            std::abs(age - exposure.frameSeconds) > kFrameSlack * exposure.frameSeconds)
            return false;
        const scene::TimeSpan span{
            last.seconds + kFrameSlack * exposure.frameSeconds,
            std::max(exposure.raster, exposure.close)};
        if (mMotion.isCut() || scene::isCut(mWorld, mView.camera, span))
            return false;
        const auto poseAt = [&](double seconds) {
            return math::removeScale(scene::worldFromEntity(mWorld, mView.camera, seconds));
        };
        return !scene::findsCameraCut(poseAt, last.seconds, exposure.raster, exposure.shutter.cuts);
    }

    /// By row of the last raster: the same entity's row now, or kNoRow.
    std::vector<uint32_t> findRows(const RasterRecord& last, const RasterRecord& now) const {
        std::vector<uint32_t> rows(last.entities.size(), kNoRow);
        if (last.entities == now.entities) {
            for (uint32_t row = 0; row < rows.size(); ++row)
                rows[row] = row;
            return rows;
        }
        std::vector<uint32_t> rowOfEntity;
        for (uint32_t row = 0; row < now.entities.size(); ++row) {
            const uint32_t index = now.entities[row].index;
            if (index >= rowOfEntity.size())
                rowOfEntity.resize(index + size_t{1}, kNoRow);
            rowOfEntity[index] = row;
        }
        for (size_t row = 0; row < rows.size(); ++row) {
            const uint32_t index = last.entities[row].index;
            const uint32_t found = index < rowOfEntity.size() ? rowOfEntity[index] : kNoRow;
            if (found != kNoRow && now.entities[found] == last.entities[row])
                rows[row] = found;
        }
        return rows;
    }

    LayerTables describeLast(const RasterRecord& last, const RasterRecord& now) const {
        const scene::TimeSpan span{
            last.seconds + kFrameSlack * mView.exposure.frameSeconds,
            std::max(mView.exposure.raster, mView.exposure.close)};
        return describeOther(last, now, [&](ecs::Entity entity) {
            return scene::hasNoPast(mWorld, entity, span);
        });
    }

    /// What has no past stands still during the exposure, and is in both of its rasters.
    LayerTables describeSecond(const RasterRecord& second, const RasterRecord& now) const {
        return describeOther(second, now, [](ecs::Entity) { return false; });
    }

    /// A raster that is not the frame's own.
    /// \param isUnknown (ecs::Entity) -> bool: where it was does not say where it is
    template <class IsUnknown>
    LayerTables describeOther(
        const RasterRecord& other, const RasterRecord& now, const IsUnknown& isUnknown
    ) const {
        const size_t count = other.entities.size();
        LayerBuilder layer = begin(other.pictureFromWorld, count);
        const std::vector<uint32_t> rows = findRows(other, now);
        std::vector<bool> mayMove(now.entities.size(), mayScaleMotion(mWorld, mView.exposure));
        for (const uint32_t row : mFrame.movingRows)
            mayMove[row] = true;
        for (size_t row = 0; row < count; ++row) {
            const uint32_t current = rows[row];
            if (current == kNoRow || other.deforms[row] || now.deforms[current]) {
                layer.setMover(row, shader::kNoMover);
                continue;
            }
            const bool wasMoved = other.worldFromObject[row] != now.worldFromObject[current];
            const ecs::Entity entity = other.entities[row];
            if (!wasMoved && !(mayMove[current] && mMotion.mayObjectMove(entity)))
                continue;
            if (isUnknown(entity))
                layer.setMover(row, shader::kNoMover);
            else
                addMover(layer, row, entity, other.worldFromObject[row]);
        }
        return layer.take();
    }

    const scene::World& mWorld;
    const ViewRequest& mView;
    const ExtractedFrame& mFrame;
    const scene::Camera& mCamera;
    scene::ExposureMotion mMotion;
    std::vector<double> mTimes;
    std::vector<dmat4> mPictures; ///< one per instant
    dmat4 mRasterPicture{1.0};
};

} // namespace

InstantTables computeInstantTables(
    const scene::World& world,
    const ViewRequest& view,
    const ExtractedFrame& frame,
    uint32_t instantCount,
    const RasterRecord* last,
    const InstantFrame* second
) {
    SHUTTER_CHECK(instantCount > 0, "no instants");
    return Builder(world, view, frame, instantCount).run(last, second);
}

} // namespace shutter::extract
