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
using math::dvec3;
using math::dvec4;

constexpr uint32_t kNoRow = 0xFFFFFFFFu;
/// Share of a frame's duration within which two times are the same: frame times are rounded.
constexpr double kFrameSlack = 1.0e-3;

/// Picture space from view space.
dmat4 makePicture(const dmat4& clipFromView, const ViewRequest& view) {
    const dmat4 rows = glm::transpose(clipFromView);
    const math::dvec2 size(view.width, view.height);
    dmat4 picture(0.0); // its rows
    for (int axis = 0; axis < 2; ++axis)
        picture[axis] = 0.5 * size[axis] * (rows[axis] + rows[3]) - view.jitterPx[axis] * rows[3];
    picture[2] = dvec4(0.0, 0.0, -1.0, 0.0);
    picture[3] = dvec4(0.0, 0.0, 0.0, 1.0);
    return glm::transpose(picture);
}

/// Places have no meaning for the sky: only directions.
dmat4 withoutTranslation(const dmat4& matrix) {
    dmat4 result = matrix;
    result[3] = dvec4(0.0, 0.0, 0.0, 1.0);
    return result;
}

shader::InstantMotion makeMotion(const dmat4& instantFromRaster) {
    shader::InstantMotion motion{};
    const dmat4 inverse = glm::inverse(instantFromRaster);
    if (!math::isFinite(instantFromRaster) || !math::isFinite(inverse))
        return motion;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            motion.instantFromRaster[row][column] = float(instantFromRaster[column][row]);
            motion.rasterFromInstant[row][column] = float(inverse[column][row]);
        }
    return motion;
}

bool anyBlurScale(const scene::World& world) {
    const auto view = world.registry.view<scene::MotionBlur>();
    return view.begin() != view.end();
}

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

    InstantTables run(const RasterRecord* last) {
        InstantTables tables;
        tables.isPerspective = mCamera.kind == scene::CameraKind::Perspective;
        tables.times.assign(mTimes.begin(), mTimes.end());
        tables.record = makeRecord();
        tables.raster = describeRaster();
        if (last && mayUse(*last))
            tables.last = describeLast(*last, tables.record);
        return tables;
    }

  private:
    /// Picture space at shutter time s from the world.
    dmat4 pictureAt(double s) const {
        const double aspect = double(mView.width) / mView.height;
        const dmat4 clip = makeProjection(mCamera, mMotion.cameraYFov(s), aspect);
        const dmat4 worldFromView = computeWorldFromView(mMotion.worldFromCamera(s));
        return makePicture(clip, mView) * glm::inverse(worldFromView);
    }

    RasterRecord makeRecord() const {
        RasterRecord record;
        record.seconds = mView.exposure.raster;
        record.camera = mView.camera;
        record.width = mView.width;
        record.height = mView.height;
        record.pictureFromWorld = mRasterPicture;
        // Rows of others' making stand behind those that were drawn.
        const auto drawn = std::ptrdiff_t(mFrame.worldFromObject.size());
        record.entities.assign(mFrame.entityHandles.begin(), mFrame.entityHandles.begin() + drawn);
        record.worldFromObject = mFrame.worldFromObject;
        record.deforms.assign(mFrame.worldFromObject.size(), false);
        for (const DeformedEntity& one : mFrame.deformed)
            record.deforms[one.row] = one.changes;
        return record;
    }

    /// The world and the sky, which every layer has.
    LayerTables begin(const dmat4& layerPicture, size_t rows) const {
        LayerTables layer;
        layer.movers.assign(rows + 1, shader::kWorldMover);
        layer.movers[rows] = shader::kSkyMover;
        layer.isStill = std::all_of(mPictures.begin(), mPictures.end(), [&](const dmat4& picture) {
            return picture == layerPicture;
        });
        const dmat4 worldFromLayer = glm::inverse(layerPicture);
        for (const dmat4& picture : mPictures)
            layer.motions.push_back(makeMotion(picture * worldFromLayer));
        const bool hasDirections = mCamera.kind == scene::CameraKind::Perspective;
        const dmat4 skyFromLayer = glm::inverse(withoutTranslation(layerPicture));
        for (const dmat4& picture : mPictures)
            layer.motions.push_back(
                makeMotion(hasDirections ? withoutTranslation(picture) * skyFromLayer : dmat4(1.0))
            );
        return layer;
    }

    void addMover(
        LayerTables& layer,
        size_t row,
        ecs::Entity entity,
        const dmat4& layerPicture,
        const dmat4& worldFromObject
    ) const {
        layer.movers[row] = static_cast<uint32_t>(layer.motions.size() / mTimes.size());
        const dmat4 objectFromLayer = glm::inverse(layerPicture * worldFromObject);
        for (size_t i = 0; i < mTimes.size(); ++i)
            layer.motions.push_back(makeMotion(
                mPictures[i] * mMotion.worldFromObject(entity, mTimes[i]) * objectFromLayer
            ));
    }

    LayerTables describeRaster() const {
        const size_t rows = mFrame.worldFromObject.size();
        LayerTables layer = begin(mRasterPicture, rows);
        const auto describe = [&](size_t row) {
            const ecs::Entity entity = mFrame.entityHandles[row];
            if (mMotion.mayObjectMove(entity))
                addMover(layer, row, entity, mRasterPicture, mFrame.worldFromObject[row]);
        };
        // What an artist's scale, or a cap, moves is static in the world.
        if (anyBlurScale(mWorld) || !mView.exposure.cap.movers.empty()) {
            for (size_t row = 0; row < rows; ++row)
                describe(row);
        } else {
            for (const uint32_t row : mFrame.movingRows)
                describe(row);
        }
        for (const DeformedEntity& one : mFrame.deformed)
            if (one.changes)
                layer.movers[one.row] = shader::kDeformedMover;
        return layer;
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
        const size_t count = last.entities.size();
        LayerTables layer = begin(last.pictureFromWorld, count);
        const std::vector<uint32_t> rows = findRows(last, now);
        const scene::TimeSpan span{
            last.seconds + kFrameSlack * mView.exposure.frameSeconds,
            std::max(mView.exposure.raster, mView.exposure.close)};
        const bool scales = anyBlurScale(mWorld) || !mView.exposure.cap.movers.empty();
        std::vector<bool> mayMove(now.entities.size(), scales);
        for (const uint32_t row : mFrame.movingRows)
            mayMove[row] = true;
        for (size_t row = 0; row < count; ++row) {
            const uint32_t current = rows[row];
            if (current == kNoRow || last.deforms[row] || now.deforms[current]) {
                layer.movers[row] = shader::kNoMover;
                continue;
            }
            const bool wasMoved = last.worldFromObject[row] != now.worldFromObject[current];
            const ecs::Entity entity = last.entities[row];
            if (!wasMoved && !(mayMove[current] && mMotion.mayObjectMove(entity)))
                continue;
            if (scene::hasNoPast(mWorld, entity, span))
                layer.movers[row] = shader::kNoMover;
            else
                addMover(layer, row, entity, last.pictureFromWorld, last.worldFromObject[row]);
        }
        return layer;
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
    const RasterRecord* last
) {
    SHUTTER_CHECK(instantCount > 0, "no instants");
    return Builder(world, view, frame, instantCount).run(last);
}

} // namespace shutter::extract
