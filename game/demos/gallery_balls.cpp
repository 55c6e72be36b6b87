// SPDX-License-Identifier: MIT
#include "game/demos/gallery_balls.h"

#include "engine/scene/history.h"
#include "game/demos/demo.h"
#include "game/demos/stage.h"

#include <vector>

namespace shutter::game {

using math::dvec3;

namespace {

constexpr double kRestitution = 0.62;
constexpr double kGrip = 0.25;    // of the sliding speed that a bounce turns into spin
constexpr double kMaxSpin = 60.0; // rad/s

/// Off a plane at `wall` across `axis`; `side` is +1 where the room lies above it.
void bounce(Ball& ball, dvec3& place, int axis, double wall, double side) {
    const double depth = (wall - place[axis]) * side + kBallRadius;
    if (depth <= 0.0)
        return;
    place[axis] += side * depth;
    if (ball.velocity[axis] * side >= 0.0)
        return;
    dvec3 normal(0.0);
    normal[axis] = side;
    const double into = glm::dot(ball.velocity, normal);
    const dvec3 sliding = ball.velocity - normal * into;
    ball.velocity = sliding * (1.0 - kGrip) - normal * (into * kRestitution);
    // As it would roll on.
    ball.spin = glm::cross(normal, ball.velocity) / kBallRadius;
    const double turning = glm::length(ball.spin);
    if (turning > kMaxSpin)
        ball.spin *= kMaxSpin / turning;
}

void stepBall(Ball& ball, math::Transform& pose, const BallRoom& room) {
    constexpr double dt = kDemoStepSeconds;
    ball.seconds += dt;
    ball.velocity.y -= kGravity * dt;
    pose.translation += ball.velocity * dt;
    for (int axis = 0; axis < 3; ++axis) {
        bounce(ball, pose.translation, axis, room.low[axis], 1.0);
        bounce(ball, pose.translation, axis, room.high[axis], -1.0);
    }
    pose.rotation = glm::normalize(math::integrateRotation(ball.spin, dt) * pose.rotation);
}

} // namespace

void throwBall(scene::World& world, const dvec3& from, const dvec3& velocity, double seconds) {
    ecs::Entity chosen;
    double longest = -1.0;
    for (auto [entity, ball] : world.registry.view<const Ball>()) {
        const double waited = ball.flies ? ball.seconds : kBallSeconds + 1.0;
        if (waited <= longest)
            continue;
        longest = waited;
        chosen = entity;
    }
    if (chosen == ecs::kNullEntity)
        return;
    Ball& ball = world.registry.get<Ball>(chosen);
    ball = {.velocity = velocity, .flies = true, .flash = ball.flash};
    ball.spin = glm::cross(velocity, dvec3(0.0, 1.0, 0.0)) * 0.8;
    auto& pose = world.registry.get<SimulatedPose>(chosen);
    pose.transform.translation = from;
    pose.jumped = true;
    scene::show(world, chosen, seconds);
}

void stepBalls(scene::World& world, const BallRoom& room) {
    std::vector<ecs::Entity> spent;
    for (auto [entity, ball, pose] : world.registry.view<Ball, SimulatedPose>()) {
        if (!ball.flies)
            continue;
        stepBall(ball, pose.transform, room);
        if (ball.seconds < kBallSeconds)
            continue;
        ball.flies = false;
        spent.push_back(entity);
    }
    for (const ecs::Entity entity : spent)
        scene::hide(world, entity);
}

double measureEnergy(const Ball& ball, double height) {
    return 0.5 * glm::dot(ball.velocity, ball.velocity) + kGravity * height;
}

} // namespace shutter::game
