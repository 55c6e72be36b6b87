// SPDX-License-Identifier: MIT
#include "game/demos/rally_posts.h"

#include "game/demos/stage.h"

#include <cmath>

namespace shutter::game {

using math::dvec2;
using math::dvec3;

namespace {

constexpr double kSpeedTaken = 0.03; // of the car's, by a post of a two-hundredth of its mass
constexpr double kLift = 0.13; // of the car's speed: the bumper meets the post below its middle

bool meets(const CarState& car, const Rod& rod) {
    const dvec2 offset = dvec2(rod.place.x, rod.place.z) - car.place;
    return std::abs(glm::dot(offset, car.forward())) < kCarHalfLength + rod.radius &&
           std::abs(glm::dot(offset, car.right())) < kCarHalfWidth + rod.radius;
}

void throwPost(Rod& rod, const CarState& car) {
    const double speed = glm::length(car.velocity);
    const dvec2 beside = dvec2(rod.place.x, rod.place.z) - car.place;
    const dvec2 aside = car.right() * glm::dot(beside, car.right()) * 0.12;
    const dvec2 ground = car.velocity * 0.9 + aside * speed;
    rod.velocity = {ground.x, kLift * speed, ground.y};
    // The foot is kicked ahead, the head falls back towards the car.
    const dvec3 ahead(car.velocity.x, 0.0, car.velocity.y);
    rod.spin = glm::cross(dvec3(0.0, 1.0, 0.0), ahead) * -0.7;
}

} // namespace

int hitPosts(ecs::Registry& registry, CarState& car) {
    int hits = 0;
    for (auto [entity, post] : registry.view<Post>()) {
        (void)entity;
        if (!post.isStanding || !meets(car, post.rod))
            continue;
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
