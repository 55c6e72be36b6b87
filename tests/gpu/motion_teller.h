// SPDX-License-Identifier: MIT
// How the engine's own scene moves, in the words of a host.
#pragma once

#include "engine/extract/frame_view.h"
#include "engine/render/post_effect.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "modules/motion_blur/embedding/host_motion.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace shutter::test {

/// The engine's own scene, as a host would tell of it.
class Teller {
  public:
    /// \param instantCount of the method
    /// \param times of the keys besides the raster instant; empty: the instants
    explicit Teller(uint32_t instantCount, std::vector<double> times = {})
        : mInstantCount(instantCount), mTimes(std::move(times)) {}

    void tell(
        const scene::World& world,
        const render::PostContext& context,
        motion_blur::HostMotion& motion
    ) {
        const scene::ExposureInterval& exposure = context.view.exposure;
        const scene::ExposureMotion moves(world, context.view.camera, exposure);
        const std::vector<double> times = listTimes(exposure);
        const auto& camera = world.registry.get<scene::Camera>(context.view.camera);
        mKeys.clear();
        for (const double s : times)
            mKeys.push_back(
                {s,
                 glm::inverse(moves.worldFromCamera(s)),
                 extract::makeProjection(camera, moves.cameraYFov(s), context.view)}
            );
        tellMovers(context.frame, moves, times, exposure.rasterTime);
        mResponse = scene::computeResponseTable(exposure.shutter.response);
        motion.keys = mKeys;
        motion.rowCount = uint32_t(context.frame.worldFromObject.size());
        motion.movers = mMovers;
        motion.rowIds = mIds;
        motion.response = mResponse ? &*mResponse : nullptr;
        motion.followsLast = followsLast;
    }

    bool followsLast = false;
    bool knowsMovers = true; ///< false: only which rows move, not how

  private:
    [[nodiscard]] std::vector<double> listTimes(const scene::ExposureInterval& exposure) const {
        std::vector<double> times = mTimes;
        if (times.empty())
            for (uint32_t i = 0; i < mInstantCount; ++i)
                times.push_back(
                    scene::invertResponse(exposure.shutter.response, (i + 0.5) / mInstantCount)
                );
        if (std::find(times.begin(), times.end(), exposure.rasterTime) == times.end())
            times.push_back(exposure.rasterTime);
        std::sort(times.begin(), times.end());
        return times;
    }

    /// All rows, whether they move or not.
    void tellMovers(
        const extract::ExtractedFrame& frame,
        const scene::ExposureMotion& moves,
        const std::vector<double>& times,
        double rasterTime
    ) {
        const size_t rows = frame.worldFromObject.size();
        mMovers.clear();
        mIds.clear();
        mMatrices.assign(rows, {});
        for (uint32_t row = 0; row < rows; ++row) {
            const ecs::Entity entity = frame.entityHandles[row];
            mIds.push_back(uint64_t(entity.generation) << 32u | entity.index);
            if (!knowsMovers && moves.mayObjectMove(entity))
                mMovers.push_back({row, {}});
            if (!knowsMovers)
                continue;
            for (const double s : times)
                mMatrices[row].push_back(
                    s == rasterTime ? frame.worldFromObject[row] : moves.worldFromObject(entity, s)
                );
            mMovers.push_back({row, mMatrices[row]});
        }
    }

    uint32_t mInstantCount;
    std::vector<double> mTimes;
    std::vector<motion_blur::HostCameraKey> mKeys;
    std::vector<motion_blur::HostMover> mMovers;
    std::vector<std::vector<math::dmat4>> mMatrices;
    std::vector<uint64_t> mIds;
    std::optional<shader::ResponseTable> mResponse;
};

} // namespace shutter::test
