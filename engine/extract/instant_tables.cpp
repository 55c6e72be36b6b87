// SPDX-License-Identifier: MIT
#include "engine/extract/instant_tables.h"

#include "engine/core/check.h"
#include "engine/extract/frame_view.h"
#include "engine/math/lens_tables.h"
#include "engine/scene/deformation.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace shutter::extract {

namespace {

using math::dmat4;
using math::LayerBuilder;
using math::LayerTables;

/// Shutter times that a shape's way is drawn through.
constexpr std::array kWayTimes{0.0, 0.5, 1.0};

/// As many joints, targets and waves.
bool hasSameParts(const scene::Deformation& a, const scene::Deformation& b) {
    return a.objectFromBind.size() == b.objectFromBind.size() &&
           a.morphWeights.size() == b.morphWeights.size() &&
           a.waves.waves.size() == b.waves.waves.size();
}

/// Returns whether the last raster shows the same surfaces as this one, so that it adds nothing.
bool showsNothingElse(const RasterRecord& last, const RasterRecord& now) {
    return last.shapes.empty() && now.shapes.empty() && last.entities == now.entities &&
           last.unjitteredFromWorld == now.unjitteredFromWorld &&
           last.worldFromObject == now.worldFromObject && last.taken == now.taken;
}

class Builder {
  public:
    Builder(
        const scene::World& world,
        const ViewRequest& view,
        const scene::ExposureMotion& motion,
        const ExtractedFrame& frame,
        uint32_t instantCount
    )
        : mWorld(world), mView(view), mFrame(frame),
          mCamera(world.registry.get<scene::Camera>(view.camera)), mMotion(motion) {
        if (view.usesLens)
            SHUTTER_CHECK_EQ(instantCount % shader::kLensSets, 0u);
        takeTimes(view.usesLens ? instantCount / shader::kLensSets : instantCount);
        mRasterPicture = pictureFromWorldAt(mWorld, mView, mMotion, view.exposure.rasterTime);
        mShapeOfRow.assign(mFrame.worldFromObject.size(), kNoRow);
        for (uint32_t i = 0; i < mFrame.deformed.size(); ++i)
            mShapeOfRow[mFrame.deformed[i].row] = i;
    }

    InstantTables
    run(const RasterRecord* last, const InstantFrame* second, std::vector<ecs::Entity> taken) {
        InstantTables tables;
        tables.isPerspective = mCamera.kind == scene::CameraKind::Perspective;
        tables.times.assign(mTimes.begin(), mTimes.end());
        tables.record = makeRasterRecord(mWorld, mView, mMotion, mFrame, mView.exposure.rasterTime);
        tables.record.taken = std::move(taken);
        tables.raster = describeRaster(tables.rasterWays);
        if (last && isOfFrameBefore(mWorld, mView, mMotion, *last) &&
            !(mView.usesLens && showsNothingElse(*last, tables.record)))
            tables.last = describeLast(*last, tables.record, tables.lastWays);
        if (second)
            tables.second =
                describeSecond(makeSecondRecord(*second), tables.record, tables.secondWays);
        tables.middles = poseMiddles(tables);
        if (mView.usesLens)
            addLens(tables);
        return tables;
    }

  private:
    void takeTimes(uint32_t count) {
        mTimes = scene::middlesOfLight(mView.exposure, count);
        for (const double s : mTimes)
            mPictures.push_back(pictureFromWorldAt(mWorld, mView, mMotion, s));
    }

    void addLens(InstantTables& tables) const {
        std::vector<math::ThinLens> lenses;
        for (const double s : mTimes)
            lenses.push_back(describeLens(mMotion, mCamera, mView, s));
        const uint32_t turn = mView.lensTurn.value_or(0);
        const double rasterTime = mView.exposure.rasterTime;
        math::addLens(lenses, describeLens(mMotion, mCamera, mView, rasterTime), turn, tables);
    }

    RasterRecord makeSecondRecord(const InstantFrame& second) const {
        ViewRequest view = mView;
        view.jitterPx = second.jitterPx;
        return makeRasterRecord(mWorld, view, mMotion, second.frame, second.instant);
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

    /// A skin that moves as one body: its place is a joint's.
    /// \param worldFromJoint when the layer was drawn
    void addCarried(
        LayerBuilder& layer,
        size_t row,
        ecs::Entity entity,
        uint32_t joint,
        const dmat4& worldFromJoint
    ) const {
        layer.addMover(row, worldFromJoint, [&](size_t instant) {
            return mMotion.worldFromObject(entity, mTimes[instant]) *
                   mMotion.objectFromBind(entity, joint, mTimes[instant]);
        });
    }

    /// Makes the data for drawing the motion of a deforming entity.
    /// \param pose index of its pose when the layer was drawn
    ShapeWay makeWay(
        uint32_t row,
        uint32_t shape,
        uint32_t pose,
        const math::mat4& clipFromObject,
        const dmat4& pictureFromObject
    ) {
        const DeformedEntity& now = mFrame.deformed[shape];
        const ecs::Entity entity = mFrame.entityHandles[now.row];
        ExposurePlaces places;
        for (size_t i = 0; i < places.size(); ++i)
            places[i] = mMotion.worldFromObject(entity, kWayTimes[i]);
        if (!mWayPictures) {
            mWayPictures.emplace();
            for (size_t i = 0; i < kWayTimes.size(); ++i)
                (*mWayPictures)[i] = pictureFromWorldAt(mWorld, mView, mMotion, kWayTimes[i]);
        }
        const bool perspective = mCamera.kind == scene::CameraKind::Perspective;
        return {
            row,
            shape,
            now.mesh,
            pose,
            makeShapeWayRow(clipFromObject, pictureFromObject, *mWayPictures, places, perspective)};
    }

    std::vector<scene::Deformation> poseMiddles(const InstantTables& tables) const {
        std::vector<scene::Deformation> middles(mFrame.deformed.size());
        for (const auto* ways : {&tables.rasterWays, &tables.secondWays, &tables.lastWays})
            for (const ShapeWay& way : *ways) {
                scene::Deformation& middle = middles[way.shape];
                const DeformedEntity& shape = mFrame.deformed[way.shape];
                if (!shape.changes || !middle.isRest())
                    continue;
                middle = mMotion.deformationAt(mFrame.entityHandles[shape.row], kWayTimes[1]);
                // A shape that is nowhere halfway goes straight.
                if (!isFinite(middle, *shape.reach))
                    middle = shape.open;
            }
        return middles;
    }

    LayerTables describeRaster(std::vector<ShapeWay>& ways) {
        const size_t rows = mFrame.worldFromObject.size();
        LayerBuilder layer = begin(mRasterPicture, rows);
        for (const uint32_t row : mFrame.movingRows) {
            const ecs::Entity entity = mFrame.entityHandles[row];
            if (mMotion.mayObjectMove(entity))
                addMover(layer, row, entity, mFrame.worldFromObject[row]);
        }
        for (uint32_t i = 0; i < mFrame.deformed.size(); ++i) {
            const DeformedEntity& one = mFrame.deformed[i];
            const uint32_t row = one.row;
            if (one.carrier) {
                const dmat4& joint = one.raster.objectFromBind[*one.carrier];
                const ecs::Entity entity = mFrame.entityHandles[row];
                addCarried(layer, row, entity, *one.carrier, mFrame.worldFromObject[row] * joint);
            } else if (one.changes) {
                layer.setMover(row, shader::kDeformedMover);
                ways.push_back(makeWay(
                    row,
                    i,
                    i,
                    mFrame.entities[row].clipFromObjectRaster,
                    mRasterPicture * mFrame.worldFromObject[row]
                ));
            }
        }
        return layer.take();
    }

    LayerTables
    describeLast(const RasterRecord& last, const RasterRecord& now, std::vector<ShapeWay>& ways) {
        const scene::TimeSpan span = spanSince(last, mView.exposure);
        return describeOther(last, now, ways, [&](ecs::Entity entity) {
            const auto* skinned = mWorld.registry.find<scene::Skinned>(entity);
            return scene::hasNoPast(mWorld, entity, span) ||
                   (skinned != nullptr &&
                    std::any_of(
                        skinned->joints.begin(),
                        skinned->joints.end(),
                        [&](ecs::Entity joint) { return scene::hasNoPast(mWorld, joint, span); }
                    ));
        });
    }

    /// Entities without a past are static during the exposure, and are in both of its rasters.
    LayerTables describeSecond(
        const RasterRecord& second, const RasterRecord& now, std::vector<ShapeWay>& ways
    ) {
        return describeOther(second, now, ways, [](ecs::Entity) { return false; });
    }

    /// An entity that has, or had, a shape.
    /// \return false: it has and had the same one, and is like any other
    template <class IsUnknown>
    bool addShaped(
        LayerBuilder& layer,
        const RasterRecord& other,
        uint32_t pose,
        uint32_t shape,
        std::vector<ShapeWay>& ways,
        const IsUnknown& isUnknown
    ) {
        const RasterShape& then = other.shapes[pose];
        const DeformedEntity& now = mFrame.deformed[shape];
        const ecs::Entity entity = mFrame.entityHandles[now.row];
        if (then.mesh != now.mesh || !hasSameParts(then.pose, now.raster)) {
            layer.setMover(then.row, shader::kNoMover);
            return true;
        }
        const double rounding = measureRounding(now.bounds);
        if (!now.changes && isNear(then.pose, now.raster, *now.reach, rounding))
            return false;
        if (isUnknown(entity)) {
            layer.setMover(then.row, shader::kNoMover);
            return true;
        }
        const dmat4& worldFromObject = other.worldFromObject[then.row];
        const auto carrier = !now.changes || now.carrier
                                 ? findCarrier(then.pose, now.raster, *now.reach, rounding)
                                 : std::nullopt;
        if (carrier) {
            const dmat4 joint = worldFromObject * then.pose.objectFromBind[*carrier];
            addCarried(layer, then.row, entity, *carrier, joint);
            return true;
        }
        layer.setMover(then.row, shader::kDeformedMover);
        ways.push_back(makeWay(
            then.row, shape, pose, then.clipFromObject, other.pictureFromWorld * worldFromObject
        ));
        return true;
    }

    /// Whether an entity without a row is not drawn only because it has shrunk to nothing.
    bool isTooSmall(ecs::Entity entity) const {
        return mWorld.registry.isAlive(entity) &&
               mWorld.registry.has<scene::MeshInstance>(entity) &&
               !scene::isHidden(mWorld, entity) && !scene::isDeformable(mWorld, entity) &&
               mMotion.mayObjectMove(entity);
    }

    /// Adds a raster other than the frame's own.
    /// \param isUnknown (ecs::Entity) -> bool: its former place does not imply the present one
    template <class IsUnknown>
    LayerTables describeOther(
        const RasterRecord& other,
        const RasterRecord& now,
        std::vector<ShapeWay>& ways,
        const IsUnknown& isUnknown
    ) {
        const size_t count = other.entities.size();
        LayerBuilder layer = begin(other.pictureFromWorld, count);
        const std::vector<uint32_t> rows = findRows(other, now.entities);
        std::vector<bool> mayMove(now.entities.size(), false);
        for (const uint32_t row : mFrame.movingRows)
            mayMove[row] = true;
        std::vector<uint32_t> poseOfRow(count, kNoRow);
        for (uint32_t i = 0; i < other.shapes.size(); ++i)
            poseOfRow[other.shapes[i].row] = i;
        for (size_t row = 0; row < count; ++row) {
            const uint32_t current = rows[row];
            const ecs::Entity entity = other.entities[row];
            const uint32_t shape = current == kNoRow ? kNoRow : mShapeOfRow[current];
            const bool isSeen = current != kNoRow || isTooSmall(entity);
            if (!isSeen || (shape == kNoRow) != (poseOfRow[row] == kNoRow)) {
                layer.setMover(row, shader::kNoMover);
                continue;
            }
            if (shape != kNoRow && addShaped(layer, other, poseOfRow[row], shape, ways, isUnknown))
                continue;
            const bool wasMoved =
                current == kNoRow || other.worldFromObject[row] != now.worldFromObject[current];
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
    const scene::ExposureMotion& mMotion;
    std::vector<double> mTimes;   ///< of instants; with a lens of samples
    std::vector<dmat4> mPictures; ///< one per instant of mTimes
    dmat4 mRasterPicture{1.0};
    std::vector<uint32_t> mShapeOfRow; ///< index into ExtractedFrame::deformed, or kNoRow
    std::optional<ExposurePictures> mWayPictures; ///< at kWayTimes
};

} // namespace

InstantTables computeInstantTables(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    uint32_t instantCount,
    const RasterRecord* last,
    const InstantFrame* second,
    std::vector<ecs::Entity> taken
) {
    SHUTTER_CHECK(instantCount > 0, "no instants");
    return Builder(world, view, motion, frame, instantCount).run(last, second, std::move(taken));
}

} // namespace shutter::extract
