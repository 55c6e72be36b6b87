// SPDX-License-Identifier: MIT
// How much of its motion a frame keeps where CameraShutter::maxBlurPercent caps it.
//
// What moves too far for the cap moves less as a whole, as if its exposure were shorter: all that
// stands still in the world together with the camera, each mover by itself. A cap of each pixel's
// motion vector would be no motion of anything: no ray could find it, nor could truth show it.
#pragma once

#include "engine/ecs/entity.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace shutter::scene {

struct MotionCap {
    /// Share of its motion that the camera keeps, and what has no share of its own, [0, 1].
    double camera = 1.0;
    /// Movers' shares of their motion on the screen, [0, 1], by rising entity index.
    std::vector<std::pair<ecs::Entity, double>> movers;

    /// Null: it has no share of its own.
    [[nodiscard]] const double* findMover(ecs::Entity entity) const {
        const auto at = std::lower_bound(
            movers.begin(),
            movers.end(),
            entity.index,
            [](const auto& mover, uint32_t index) { return mover.first.index < index; }
        );
        return at != movers.end() && at->first == entity ? &at->second : nullptr;
    }

    [[nodiscard]] double of(ecs::Entity entity) const {
        const double* share = findMover(entity);
        return share ? *share : camera;
    }
};

} // namespace shutter::scene
