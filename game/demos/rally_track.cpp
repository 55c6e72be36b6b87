// SPDX-License-Identifier: MIT
#include "game/demos/rally_track.h"

#include "engine/core/check.h"
#include "engine/scene/path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace shutter::game {

using math::dvec2;
using math::dvec3;

namespace {

constexpr double kFencePanelHalfLength = 2.02; // metres
constexpr double kFenceRestitution = 0.25;
constexpr double kFenceScrape = 0.985; // of the speed along the fence that a touching step leaves

dvec2 nearestOn(const dvec2& from, const dvec2& to, const dvec2& place) {
    const dvec2 along = to - from;
    const double length2 = glm::dot(along, along);
    const double share =
        length2 > 0.0 ? std::clamp(glm::dot(place - from, along) / length2, 0.0, 1.0) : 0.0;
    return from + along * share;
}

/// The curve through the gates is a path whose keys are the gates, one per second.
std::vector<dvec2> sampleCentreLine(const std::vector<Gate>& gates) {
    constexpr int kPointsPerGate = 24;
    const auto count = static_cast<int>(gates.size());
    scene::PathMotion path;
    for (int i = -1; i <= count + 1; ++i) {
        const dvec2& place = gates[static_cast<size_t>((i + count) % count)].place;
        scene::PathKey key;
        key.seconds = i;
        key.position = dvec3(place.x, 0.0, place.y);
        path.keys.push_back(key);
    }
    std::vector<dvec2> points;
    for (int i = 0; i <= count * kPointsPerGate; ++i) {
        const dvec3 point =
            scene::samplePath(path, {}, static_cast<double>(i) / kPointsPerGate).translation;
        points.emplace_back(point.x, point.z);
    }
    return points;
}

} // namespace

RallyTrack::RallyTrack(std::vector<Gate> gates)
    : mGates(std::move(gates)), mCentreLine(sampleCentreLine(mGates)) {
    SHUTTER_CHECK(mGates.size() >= 3, "a track of {} gates", mGates.size());
}

double RallyTrack::measureDistance(const dvec2& place) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 1; i < mCentreLine.size(); ++i)
        nearest = std::min(
            nearest, glm::distance(place, nearestOn(mCentreLine[i - 1], mCentreLine[i], place))
        );
    return nearest;
}

bool RallyTrack::isOnRoad(const dvec2& place) const {
    return measureDistance(place) <= kRoadHalfWidth;
}

bool passesGate(const Gate& gate, const dvec2& from, const dvec2& to) {
    const double before = glm::dot(from - gate.place, gate.direction);
    const double after = glm::dot(to - gate.place, gate.direction);
    if (!(before < 0.0 && after >= 0.0))
        return false;
    const dvec2 crossing = from + (to - from) * (before / (before - after));
    const dvec2 across(-gate.direction.y, gate.direction.x);
    return std::abs(glm::dot(crossing - gate.place, across)) <= kGateHalfWidth;
}

bool collideWithFences(CarState& car, std::span<const Fence> fences) {
    bool touched = false;
    for (const Fence& fence : fences) {
        const dvec2 away = car.place - nearestOn(fence.from, fence.to, car.place);
        const double distance = glm::length(away);
        if (!(distance < kCarHalfWidth) || distance == 0.0)
            continue;
        touched = true;
        const dvec2 normal = away / distance;
        car.place += normal * (kCarHalfWidth - distance);
        const double into = glm::dot(car.velocity, normal);
        if (into < 0.0)
            car.velocity =
                (car.velocity - normal * into) * kFenceScrape - normal * (kFenceRestitution * into);
    }
    return touched;
}

Gate readGate(const math::Transform& node) {
    const dvec3 forward = node.rotation * dvec3(0.0, 0.0, -1.0);
    return {{node.translation.x, node.translation.z}, glm::normalize(dvec2(forward.x, forward.z))};
}

Fence readFence(const math::Transform& node) {
    const dvec3 along = node.rotation * dvec3(kFencePanelHalfLength, 0.0, 0.0);
    const dvec2 middle(node.translation.x, node.translation.z);
    return {middle - dvec2(along.x, along.z), middle + dvec2(along.x, along.z)};
}

bool advance(RallyProgress& progress, const RallyTrack& track, const dvec2& from, const dvec2& to) {
    const auto count = static_cast<int>(track.gates().size());
    for (int skipped = 0; skipped <= 2; ++skipped) {
        const int gate = (progress.nextGate + skipped) % count;
        if (!passesGate(track.gates()[static_cast<size_t>(gate)], from, to))
            continue;
        // Gate 0 ends the lap, whether it is this one or was missed.
        if (progress.nextGate == 0 || progress.nextGate + skipped >= count)
            ++progress.lap;
        ++progress.gatesPassed;
        progress.nextGate = (gate + 1) % count;
        return true;
    }
    return false;
}

} // namespace shutter::game
