// SPDX-License-Identifier: MIT
#include "game/demos/gallery_targets.h"

#include "game/demos/demo.h"
#include "game/demos/stage.h"

#include <algorithm>
#include <cmath>

namespace shutter::game {

using math::dvec2;
using math::dvec3;

namespace {

constexpr double kFallRate = 11.0;       // rad/s
constexpr double kFallen = 1.50;         // radians: almost flat
constexpr double kDownSeconds = 1.6;     // until it comes again
constexpr double kFaceHalfDepth = 0.025; // metres
/// Share of the ball's radius within which it must hit: grazing the rim does not count.
constexpr double kGraze = 0.7;

void enter(Target& target, Random& random) {
    const double side = target.speed < 0.0 ? 1.0 : -1.0;
    target.along = side * target.halfLength;
    target.speed = -side * random.between(target.slowest, target.fastest);
    target.fall = 0.0;
    target.downSeconds = -1.0;
}

} // namespace

void stepTargets(ecs::Registry& registry, Random& random) {
    constexpr double dt = kDemoStepSeconds;
    for (auto [entity, target, pose] : registry.view<Target, SimulatedPose>()) {
        (void)entity;
        if (target.downSeconds >= 0.0) {
            target.downSeconds += dt;
            target.fall = std::min(target.fall + kFallRate * dt, kFallen);
        }
        target.along += target.speed * dt;
        if (std::abs(target.along) > target.halfLength) {
            // Those that were hit ride on out of sight, and wait there.
            target.along = std::copysign(target.halfLength, target.along);
            if (target.downSeconds < 0.0 || target.downSeconds > kDownSeconds) {
                enter(target, random);
                pose.jumped = true;
            }
        }
        pose.transform.translation = target.rail + dvec3(target.along, 0.0, 0.0);
        pose.transform.rotation = glm::angleAxis(-target.fall, dvec3(1.0, 0.0, 0.0));
    }
}

std::optional<TargetHit> hitTarget(ecs::Registry& registry, const dvec3& ball, double ballRadius) {
    for (auto [entity, target] : registry.view<Target>()) {
        if (target.downSeconds >= 0.0)
            continue;
        const dvec3 face = target.rail + dvec3(target.along, target.faceHeight, 0.0);
        const dvec3 offset = ball - face;
        if (std::abs(offset.z) > kFaceHalfDepth + ballRadius ||
            glm::length(dvec2(offset)) > target.radius + kGraze * ballRadius)
            continue;
        target.downSeconds = 0.0;
        return TargetHit{entity, std::abs(target.speed)};
    }
    return std::nullopt;
}

int pointsFor(const TargetHit& hit) {
    return static_cast<int>(std::lround(10.0 * hit.speed));
}

} // namespace shutter::game
