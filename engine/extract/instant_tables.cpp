// SPDX-License-Identifier: MIT
#include "engine/extract/instant_tables.h"

#include "engine/core/check.h"
#include "engine/extract/frame_view.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::extract {

namespace {

using math::dmat4;
using math::LayerBuilder;
using math::LayerTables;

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
            mPictures.push_back(pictureFromWorldAt(mWorld, mView, mMotion, s));
        mRasterPicture = pictureFromWorldAt(mWorld, mView, mMotion, view.exposure.rasterTime);
    }

    InstantTables run(const RasterRecord* last, const InstantFrame* second) {
        InstantTables tables;
        tables.isPerspective = mCamera.kind == scene::CameraKind::Perspective;
        tables.times.assign(mTimes.begin(), mTimes.end());
        tables.record = makeRasterRecord(mView, mFrame, mView.exposure.raster, mRasterPicture);
        tables.raster = describeRaster();
        if (last && mayUse(*last))
            tables.last = describeLast(*last, tables.record);
        if (second)
            tables.second = describeSecond(makeSecondRecord(*second), tables.record);
        return tables;
    }

  private:
    RasterRecord makeSecondRecord(const InstantFrame& second) const {
        ViewRequest view = mView;
        view.jitterPx = second.jitterPx;
        const dmat4 picture = pictureFromWorldAt(mWorld, view, mMotion, second.instant);
        return makeRasterRecord(view, second.frame, mView.exposure.at(second.instant), picture);
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
        for (const uint32_t row : mFrame.movingRows) {
            const ecs::Entity entity = mFrame.entityHandles[row];
            if (mMotion.mayObjectMove(entity))
                addMover(layer, row, entity, mFrame.worldFromObject[row]);
        }
        for (const DeformedEntity& one : mFrame.deformed)
            if (one.changes)
                layer.setMover(one.row, shader::kDeformedMover);
        return layer.take();
    }

    bool mayUse(const RasterRecord& last) const {
        const scene::ExposureInterval& exposure = mView.exposure;
        const double age = exposure.raster - last.seconds;
        return age > 0.0 &&
               std::abs(age - exposure.frameSeconds) <= kFrameSlack * exposure.frameSeconds &&
               showsTheSame(mWorld, mView, mMotion, last);
    }

    LayerTables describeLast(const RasterRecord& last, const RasterRecord& now) const {
        const scene::TimeSpan span = spanSince(last, mView.exposure);
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
        const std::vector<uint32_t> rows = findRows(other, now.entities);
        std::vector<bool> mayMove(now.entities.size(), false);
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
        layer.setRasterRows(rows);
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
