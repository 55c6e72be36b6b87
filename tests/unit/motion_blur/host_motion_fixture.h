// SPDX-License-Identifier: MIT
// A host whose camera goes and turns, and what it says of it.
#pragma once

#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_instants.h"
#include "shaders/common/shutter_response_shared.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace shutter::motion_blur {

class HostMotionFixture : public ::testing::Test {
  protected:
    static constexpr uint32_t kInstants = 5;
    static constexpr uint32_t kRows = 4;

    HostMotionFixture() {
        frame.sizePx = {200, 100};
        frame.rasterTime = 1.0;
        frame.instantCount = kInstants;
        setKeys({0.0, 0.5, 1.0});
    }

    static math::dmat4
    place(const math::dvec3& at, const math::dvec3& axis, double angle, double scale = 1.0) {
        math::Transform transform;
        transform.translation = at;
        transform.rotation = glm::angleAxis(angle, glm::normalize(axis));
        transform.scale = math::dvec3(scale);
        return math::computeMatrix(transform);
    }

    /// Seconds, frames and shutter times are one: time 1 of a frame is time 0 of the next.
    static math::dmat4 worldFromViewAt(double seconds) {
        const math::dvec3 at = math::dvec3(0.3, -0.1, 0.4) * seconds;
        return place(at, {1.0, 2.0, 3.0}, 0.2 * seconds);
    }

    /// Turns by less than half a turn from key to key, and is scaled.
    static math::dmat4 worldFromTumblerAt(double seconds) {
        return place(
            math::dvec3(0.5, 0.2, -8.0) + math::dvec3(1.0, 0.5, 1.5) * seconds,
            {2.0, 3.0, 1.0},
            3.7 * seconds,
            2.5
        );
    }

    [[nodiscard]] math::dmat4 projection() const {
        return isPerspective ? math::clipFromViewPerspective(0.9, 2.0, 0.1)
                             : math::clipFromViewOrthographic(6.0, 3.0, 0.1, 100.0);
    }

    /// Keys at these shutter times, of the frame that opens at `openSeconds`.
    void setKeys(const std::vector<double>& times) {
        keys.clear();
        for (const double time : times) {
            const math::dmat4 view = glm::inverse(worldFromViewAt(openSeconds + time));
            keys.push_back({time, view, projection()});
        }
        motion.keys = keys;
        motion.rowCount = kRows;
    }

    /// Row 1 is the tumbler, one matrix a key.
    void addTumbler(uint32_t row = 1) {
        matrices.clear();
        for (const HostCameraKey& key : keys)
            matrices.push_back(worldFromTumblerAt(openSeconds + key.time));
        movers = {{row, matrices}};
        motion.movers = movers;
    }

    [[nodiscard]] core::Status check() const { return checkMotion(motion, frame); }

    [[nodiscard]] HostInstants compute(const HostRaster* last = nullptr) const {
        const core::Status valid = check();
        EXPECT_TRUE(valid.ok()) << valid.error().message;
        return computeHostInstants(motion, frame, last);
    }

    bool isPerspective = true;
    double openSeconds = 0.0;
    HostMotionFrame frame;
    HostMotion motion;
    std::vector<HostCameraKey> keys;
    std::vector<HostMover> movers;
    std::vector<math::dmat4> matrices;
};

} // namespace shutter::motion_blur
