// SPDX-License-Identifier: MIT
#pragma once

#include "engine/math/transform.h"
#include "game/demos/rally_car.h"

namespace shutter::game {

/// A camera on two springs behind a car: one turns it round, one holds its distance.
struct ChaseCamera {
    double heading = 0.0;      ///< as CarState's
    double headingRate = 0.0;  ///< rad/s
    double distance = 5.4;     ///< metres behind the car's middle
    double distanceRate = 0.0; ///< m/s
};

/// One step of kDemoStepSeconds.
void stepChase(ChaseCamera& camera, const CarState& car);

/// Of the camera's entity, a root; looks along its -Z.
[[nodiscard]] math::Transform chasePose(const ChaseCamera& camera, const CarState& car);

} // namespace shutter::game
