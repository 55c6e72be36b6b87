// SPDX-License-Identifier: MIT
// The rally's track: gates, road and fences, read from the scene's nodes.
#pragma once

#include "engine/math/math.h"
#include "engine/math/transform.h"
#include "game/demos/rally_car.h"

#include <span>
#include <vector>

namespace shutter::game {

inline constexpr double kGateHalfWidth = 6.5;  ///< metres
inline constexpr double kRoadHalfWidth = 4.95; ///< metres, kerbs included

struct Gate {
    math::dvec2 place{0.0};     ///< x, z
    math::dvec2 direction{0.0}; ///< of driving, unit
};

/// A closed course through gates.
class RallyTrack {
  public:
    /// \param gates at least three, in driving order
    explicit RallyTrack(std::vector<Gate> gates);

    [[nodiscard]] std::span<const Gate> gates() const { return mGates; }

    /// Metres to the centre line: the Catmull-Rom curve through the gates, to 0.1 m.
    [[nodiscard]] double measureDistance(const math::dvec2& place) const;
    [[nodiscard]] bool isOnRoad(const math::dvec2& place) const;

  private:
    std::vector<Gate> mGates;
    std::vector<math::dvec2> mCentreLine; ///< points of it, closed
};

/// True if the segment from `from` to `to` crosses the gate in driving direction.
[[nodiscard]] bool passesGate(const Gate& gate, const math::dvec2& from, const math::dvec2& to);

/// A straight fence on the ground.
struct Fence {
    math::dvec2 from{0.0};
    math::dvec2 to{0.0};
};

/// Keeps the car, a disc of kCarHalfWidth here, out of the fences: it slides along them and loses
/// most of its speed across. \return true when it touched one
bool collideWithFences(CarState& car, std::span<const Fence> fences);

/// A node's pose on the ground: cars pass a gate along its -Z, a fence panel extends along its X.
[[nodiscard]] Gate readGate(const math::Transform& node);
[[nodiscard]] Fence readFence(const math::Transform& node);

/// How far the player has come.
struct RallyProgress {
    int nextGate = 1;    ///< of the track's, the one to pass
    int gatesPassed = 0; ///< of all laps
    int lap = 0;         ///< laps done
};

/// Counts a gate that the segment from `from` to `to` crosses: the next one or one of the two after
/// it, so that a missed gate does not end the race. A lap ends at gate 0.
/// \return true when one was passed
bool advance(
    RallyProgress& progress, const RallyTrack& track, const math::dvec2& from, const math::dvec2& to
);

} // namespace shutter::game
