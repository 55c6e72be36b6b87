// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_instants.h"

#include "engine/core/check.h"
#include "engine/math/lens_tables.h"
#include "modules/motion_blur/embedding/host_ways.h"
#include "shaders/common/shutter_response.glsl"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

namespace shutter::motion_blur {

namespace {

using math::dmat4;
using math::LayerBuilder;
using math::LayerTables;

constexpr uint32_t kNone = 0xFFFFFFFFu;
/// Within which a key is at the raster instant: hosts may compute the two apart.
constexpr double kSameTime = 1.0e-6;

/// Whether both rasters show the same entities in the same places.
bool showsTheSame(const HostRaster& last, const HostRaster& now) {
    const auto isSame = [](const HostRaster::Mover& a, const HostRaster::Mover& b) {
        return a.row == b.row && !a.deforms && !b.deforms && a.worldFromObject == b.worldFromObject;
    };
    return last.pictureFromWorld == now.pictureFromWorld && last.rowCount == now.rowCount &&
           last.hasViewModel == now.hasViewModel && last.rowIds == now.rowIds &&
           std::equal(
               last.movers.begin(), last.movers.end(), now.movers.begin(), now.movers.end(), isSame
           );
}

uint64_t idOf(std::span<const uint64_t> rowIds, uint32_t row) {
    return rowIds.empty() ? row : rowIds[row];
}

class Builder {
  public:
    Builder(const HostMotion& motion, const HostMotionFrame& frame)
        : mMotion(motion), mFrame(frame), mCamera(motion.keys, motion.aheadIsPlusZ) {
        const auto raster =
            std::find_if(motion.keys.begin(), motion.keys.end(), [&](const HostCameraKey& key) {
                return isRasterKey(key, frame.rasterTime);
            });
        SHUTTER_CHECK(raster != motion.keys.end(), "no key at {}", frame.rasterTime);
        mRasterKey = size_t(raster - motion.keys.begin());
        for (uint32_t i = 0; i < frame.instantCount; ++i) {
            mTimes.push_back(invertResponse(motion.response, (i + 0.5) / frame.instantCount));
            mPlaces.push_back(place(mTimes.back(), motion.cameraScale));
            mObjectPlaces.push_back(place(mTimes.back(), motion.objectScale));
            mPictures.push_back(mCamera.at(mPlaces.back()).pictureFromWorld(frame.sizePx));
        }
        mMoverOfRow.assign(motion.rowCount, kNone);
        for (uint32_t i = 0; i < motion.movers.size(); ++i) {
            const HostMover& mover = motion.movers[i];
            mMoverOfRow[mover.row] = i;
            std::optional<MoverWay>& way = mWays.emplace_back();
            if (!mover.worldFromObject.empty())
                way.emplace(mover.worldFromObject);
        }
        mIsViewModel.assign(motion.rowCount, false);
        for (const uint32_t row : motion.viewModelRows)
            mIsViewModel[row] = true;
    }

    HostInstants run(const HostRaster* last) const {
        HostInstants made;
        made.layers.times.assign(mTimes.begin(), mTimes.end());
        made.layers.isPerspective = isPerspective();
        made.raster = makeRaster();
        made.layers.raster = describeRaster(made.raster.pictureFromWorld);
        if (last && last->sizePx == mFrame.sizePx && last->isPerspective == isPerspective())
            made.layers.last = describeLast(*last);
        if (mMotion.lens.isOpen()) {
            // Another raster of the same surfaces from the same places adds nothing.
            if (last && showsTheSame(*last, made.raster))
                made.layers.last.reset();
            addLens(made.layers);
        }
        return made;
    }

  private:
    [[nodiscard]] bool isPerspective() const { return mCamera.atKey(0).isPerspective; }

    /// Between the keys, for motion that is scaled about the raster.
    [[nodiscard]] BetweenKeys place(double time, double scale) const {
        if (scale == 0.0)
            return {mRasterKey, mRasterKey, 0.0};
        const double scaled = mFrame.rasterTime + (time - mFrame.rasterTime) * scale;
        return locate(mMotion.keys, scale == 1.0 ? time : scaled);
    }

    [[nodiscard]] HostRaster makeRaster() const {
        HostRaster raster;
        raster.sizePx = mFrame.sizePx;
        raster.isPerspective = isPerspective();
        raster.pictureFromWorld = mCamera.atKey(mRasterKey).pictureFromWorld(mFrame.sizePx);
        raster.rowCount = mMotion.rowCount;
        raster.hasViewModel = mMotion.hasViewModel;
        for (const HostMover& mover : mMotion.movers) {
            const bool deforms = mover.worldFromObject.empty();
            raster.movers.push_back(
                {mover.row, deforms, deforms ? dmat4(1.0) : mover.worldFromObject[mRasterKey]}
            );
        }
        // Nothing of it is looked up in the next frame: that has its own.
        for (const uint32_t row : mMotion.viewModelRows)
            raster.movers.push_back({row, true, dmat4(1.0)});
        raster.rowIds.assign(mMotion.rowIds.begin(), mMotion.rowIds.end());
        return raster;
    }

    [[nodiscard]] math::ThinLens
    describeLens(const HostCamera& camera, const BetweenKeys& place) const {
        const HostLens& lens = mMotion.lens;
        math::ThinLens made;
        made.pixelsPerUnit = math::measurePixelsPerUnit(camera.clipFromView, mFrame.sizePx);
        // The picture's scale is the focal length's.
        const double zoom =
            made.pixelsPerUnit.y /
            math::measurePixelsPerUnit(mCamera.atKey(mRasterKey).clipFromView, mFrame.sizePx).y;
        made.radius = lens.radius * zoom;
        made.focusDistance = lens.focusDistance;
        if (!lens.focusDistances.empty()) {
            const double from = 1.0 / lens.focusDistances[place.from];
            const double to = 1.0 / lens.focusDistances[place.to];
            made.focusDistance = 1.0 / (from + (to - from) * place.share);
        }
        made.aperture = {
            lens.blades, float(lens.bladeRotation), float(lens.roundness), float(lens.squeeze)};
        return made;
    }

    void addLens(math::InstantLayers& layers) const {
        std::vector<math::ThinLens> lenses;
        for (const BetweenKeys& place : mPlaces)
            lenses.push_back(describeLens(mCamera.at(place), place));
        const BetweenKeys raster{mRasterKey, mRasterKey, 0.0};
        math::addLens(lenses, describeLens(mCamera.atKey(mRasterKey), raster), 0, layers);
    }

    /// Adds the row unless it stays where the layer has it.
    void addMover(
        LayerBuilder& layer, uint32_t row, const MoverWay& way, const dmat4& worldFromObject
    ) const {
        if (way.staysAt(worldFromObject))
            return;
        layer.addMover(row, worldFromObject, [&](size_t instant) {
            return way.at(mObjectPlaces[instant]);
        });
    }

    [[nodiscard]] LayerTables describeRaster(const dmat4& picture) const {
        LayerBuilder layer(
            picture, mPictures, isPerspective(), mMotion.rowCount + mMotion.hasViewModel
        );
        for (size_t i = 0; i < mMotion.movers.size(); ++i) {
            const HostMover& mover = mMotion.movers[i];
            if (mWays[i] && mMotion.objectScale == 0.0)
                continue; // it stays in the world where the raster has it
            if (mWays[i])
                addMover(layer, mover.row, *mWays[i], mover.worldFromObject[mRasterKey]);
            else
                layer.setMover(mover.row, shader::kDeformedMover);
        }
        for (const uint32_t row : mMotion.viewModelRows)
            layer.addFixed(row);
        if (mMotion.hasViewModel)
            addViewModel(layer);
        return layer.take();
    }

    /// The row of the view model that depth names, which the camera does not move.
    void addViewModel(LayerBuilder& layer) const {
        const std::span<const dmat4> keys = mMotion.viewFromObject;
        if (keys.empty()) {
            layer.addFixed(mMotion.rowCount);
            return;
        }
        const MoverWay way(keys);
        const dmat4& own = mMotion.viewModelProjection;
        const dmat4& clipFromView = own == dmat4(0.0) ? mMotion.keys[mRasterKey].clipFromView : own;
        const auto project = [&](const dmat4& viewFromObject) {
            const HostCameraKey key{0.0, viewFromObject, clipFromView};
            return normalize(key, mMotion.aheadIsPlusZ).value().pictureFromWorld(mFrame.sizePx);
        };
        layer.addPicture(mMotion.rowCount, project(keys[mRasterKey]), [&](size_t instant) {
            return project(way.at(mObjectPlaces[instant]));
        });
    }

    /// By row of the last raster: the same entity's row now, or kNone.
    [[nodiscard]] std::vector<uint32_t> findRows(const HostRaster& last) const {
        std::vector<uint32_t> rows(last.rowCount, kNone);
        if (mMotion.rowIds.empty() && last.rowIds.empty()) {
            for (uint32_t row = 0; row < std::min(last.rowCount, mMotion.rowCount); ++row)
                rows[row] = row;
            return rows;
        }
        std::unordered_map<uint64_t, uint32_t> rowOfId;
        for (uint32_t row = 0; row < mMotion.rowCount; ++row) {
            const auto [found, isNew] = rowOfId.emplace(idOf(mMotion.rowIds, row), row);
            if (!isNew)
                found->second = kNone;
        }
        std::vector<uint32_t> rowThen(mMotion.rowCount, kNone);
        for (uint32_t row = 0; row < last.rowCount; ++row) {
            const auto found = rowOfId.find(idOf(last.rowIds, row));
            if (found == rowOfId.end() || found->second == kNone)
                continue;
            uint32_t& then = rowThen[found->second];
            if (then == kNone) {
                then = row;
                rows[row] = found->second;
            } else {
                rows[then] = kNone; // the id occurred twice then
            }
        }
        return rows;
    }

    [[nodiscard]] LayerTables describeLast(const HostRaster& last) const {
        LayerBuilder layer(
            last.pictureFromWorld, mPictures, isPerspective(), last.rowCount + last.hasViewModel
        );
        std::vector<const HostRaster::Mover*> moverThen(last.rowCount, nullptr);
        for (const HostRaster::Mover& mover : last.movers)
            moverThen[mover.row] = &mover;
        std::vector<uint32_t> rows = findRows(last);
        for (uint32_t row = 0; row < last.rowCount; ++row) {
            const HostRaster::Mover* const then = moverThen[row];
            const uint32_t moverNow = rows[row] == kNone ? kNone : mMoverOfRow[rows[row]];
            const bool isViewModel = rows[row] != kNone && mIsViewModel[rows[row]];
            if (rows[row] != kNone && moverNow == kNone && !then && !isViewModel)
                continue; // was and is static
            const bool bothDeform = then && then->deforms && moverNow != kNone && !mWays[moverNow];
            // Without both transforms or its pixels' motion, its place is unknown.
            if (bothDeform && mFrame.knowsLastDeformed)
                layer.setMover(row, shader::kDeformedMover);
            else if (!then || then->deforms || moverNow == kNone || !mWays[moverNow])
                layer.setMover(row, shader::kNoMover);
            else
                addMover(layer, row, *mWays[moverNow], then->worldFromObject);
        }
        if (last.hasViewModel) { // as of viewModelRows
            layer.setMover(last.rowCount, shader::kNoMover);
            rows.push_back(kNone);
        }
        layer.setRasterRows(std::move(rows));
        return layer.take();
    }

    const HostMotion& mMotion;
    const HostMotionFrame& mFrame;
    CameraWay mCamera;
    size_t mRasterKey = 0;
    std::vector<double> mTimes;                 ///< of the instants
    std::vector<BetweenKeys> mPlaces;           ///< the camera's, one per instant
    std::vector<BetweenKeys> mObjectPlaces;     ///< the movers', one per instant
    std::vector<dmat4> mPictures;               ///< one per instant
    std::vector<uint32_t> mMoverOfRow;          ///< index of movers, or kNone
    std::vector<bool> mIsViewModel;             ///< by row
    std::vector<std::optional<MoverWay>> mWays; ///< one per mover; nothing: by motion vectors
};

} // namespace

double invertResponse(const shader::ResponseTable* table, double u) {
    return table ? double(shader::inverseResponse({*table}, static_cast<float>(u))) : u;
}

bool isRasterKey(const HostCameraKey& key, double rasterTime) {
    return std::abs(key.time - rasterTime) <= kSameTime;
}

HostInstants computeHostInstants(
    const HostMotion& motion, const HostMotionFrame& frame, const HostRaster* last
) {
    return Builder(motion, frame).run(last);
}

} // namespace shutter::motion_blur
