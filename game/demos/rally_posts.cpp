// SPDX-License-Identifier: MIT
#include "game/demos/rally_posts.h"

#include "engine/math/transform.h"
#include "game/demos/demo.h"
#include "game/demos/sparks.h"
#include "game/demos/stage.h"

#include <algorithm>
#include <cmath>

namespace shutter::game {

using math::dvec2;
using math::dvec3;

namespace {

constexpr double kPostRestitution = 0.35;
constexpr double kMinBounce = 0.6; // m/s: slower contacts do not bounce
constexpr double kPostFriction = 0.55;
constexpr double kPostMostSpin = 60.0; // rad/s: far below half a turn per step
constexpr double kAirDrag = 0.25;      // 1/s, of the spin
constexpr double kRestSpeed = 0.25;    // m/s, of the middle and of the ends
constexpr double kRestAfter = 0.4;     // s
const dvec3 kUp(0.0, 1.0, 0.0);

double inertiaOf(const Rod& rod) {
    return rod.halfLength * rod.halfLength / 3.0;
}

void applyImpulse(Rod& rod, const dvec3& arm, const dvec3& impulse) {
    rod.velocity += impulse;
    rod.spin += glm::cross(arm, impulse) / inertiaOf(rod);
}

/// Change of speed of the point at `arm` along `direction` by an impulse of 1.
double softness(const Rod& rod, const dvec3& arm, const dvec3& direction) {
    const dvec3 lever = glm::cross(arm, direction);
    return 1.0 + glm::dot(lever, lever) / inertiaOf(rod);
}

void meetGround(Rod& rod, const dvec3& arm) {
    const double depth = rod.radius - (rod.place + arm).y;
    if (depth < 0.0)
        return;
    rod.place.y += depth;
    const dvec3 speed = rod.velocity + glm::cross(rod.spin, arm);
    if (speed.y >= 0.0)
        return;
    const double bounce = -speed.y > kMinBounce ? kPostRestitution : 0.0;
    const double push = -(1.0 + bounce) * speed.y / softness(rod, arm, kUp);
    applyImpulse(rod, arm, kUp * push);
    const dvec3 after = rod.velocity + glm::cross(rod.spin, arm);
    const dvec3 sliding(after.x, 0.0, after.z);
    const double slide = glm::length(sliding);
    if (slide < 1.0e-9)
        return;
    const dvec3 direction = sliding / slide;
    const double stop = slide / softness(rod, arm, direction);
    applyImpulse(rod, arm, direction * -std::min(stop, kPostFriction * push));
}

constexpr uint32_t kSparksPerPost = 40;
constexpr double kSpeedTaken = 0.03; // of the car's, by a post of a two-hundredth of its mass
constexpr double kLift = 0.13; // of the car's speed: the bumper meets the post below its middle

bool meets(const CarState& car, const Rod& rod) {
    const dvec2 offset = dvec2(rod.place.x, rod.place.z) - car.place;
    return std::abs(glm::dot(offset, car.forward())) < kCarHalfLength + rod.radius &&
           std::abs(glm::dot(offset, car.right())) < kCarHalfWidth + rod.radius;
}

void throwPost(Rod& rod, const CarState& car) {
    const double speed = glm::length(car.velocity);
    const dvec2 fromCar = dvec2(rod.place.x, rod.place.z) - car.place;
    const dvec2 aside = car.right() * glm::dot(fromCar, car.right()) * 0.12;
    const dvec2 ground = car.velocity * 0.9 + aside * speed;
    rod.velocity = {ground.x, kLift * speed, ground.y};
    // The foot is kicked ahead, the head falls back towards the car.
    const dvec3 ahead(car.velocity.x, 0.0, car.velocity.y);
    rod.spin = glm::cross(dvec3(0.0, 1.0, 0.0), ahead) * -0.7;
}

} // namespace

void stepRod(Rod& rod) {
    if (rod.asleep)
        return;
    constexpr double dt = kDemoStepSeconds;
    rod.velocity.y -= kGravity * dt;
    rod.spin *= 1.0 - kAirDrag * dt;
    const double turning = glm::length(rod.spin);
    if (turning > kPostMostSpin)
        rod.spin *= kPostMostSpin / turning;
    rod.place += rod.velocity * dt;
    rod.rotation = glm::normalize(math::integrateRotation(rod.spin, dt) * rod.rotation);
    const dvec3 half = rod.rotation * (kUp * rod.halfLength);
    meetGround(rod, half);
    meetGround(rod, -half);

    const double ends = glm::length(glm::cross(rod.spin, half));
    const bool isQuiet = std::max(glm::length(rod.velocity), ends) < kRestSpeed;
    const bool lies = rod.place.y < 2.0 * rod.radius;
    rod.restSeconds = isQuiet && lies ? rod.restSeconds + dt : 0.0;
    if (rod.restSeconds < kRestAfter)
        return;
    rod.asleep = true;
    rod.velocity = rod.spin = dvec3(0.0);
}

double measureEnergy(const Rod& rod) {
    return 0.5 * glm::dot(rod.velocity, rod.velocity) +
           0.5 * inertiaOf(rod) * glm::dot(rod.spin, rod.spin) + kGravity * rod.place.y;
}

int hitPosts(ecs::Registry& registry, CarState& car, double seconds) {
    int hits = 0;
    for (auto [entity, post] : registry.view<Post>()) {
        if (!post.isStanding || !meets(car, post.rod))
            continue;
        if (registry.has<particles::ParticleEmitter>(entity))
            burst(registry, entity, seconds, kSparksPerPost);
        post.isStanding = false;
        throwPost(post.rod, car);
        car.velocity *= 1.0 - kSpeedTaken;
        ++hits;
    }
    return hits;
}

void stepPosts(ecs::Registry& registry) {
    for (auto [entity, post, pose] : registry.view<Post, SimulatedPose>()) {
        (void)entity;
        if (post.isStanding)
            continue;
        stepRod(post.rod);
        pose.transform.translation = post.rod.place;
        pose.transform.rotation = post.rod.rotation;
    }
}

} // namespace shutter::game
