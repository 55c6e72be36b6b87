// SPDX-License-Identifier: MIT
#include "game/demos/spin_demo.h"

#include "engine/core/words.h"
#include "game/demos/sparks.h"
#include "game/demos/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace shutter::game {

using math::dquat;
using math::dvec3;

namespace {

constexpr double kRideSeconds = 45.0;
constexpr double kOrbitRate = 0.5; // rad/s
constexpr double kMaxOrbit = 0.7;  // radians
constexpr double kBob = 0.20;      // metres that a seat rises and sinks
constexpr double kBobsPerTurn = 2.0;
constexpr uint32_t kSparksPerRing = 60;
constexpr double kBrakeSparksPerSecond = 300.0;
constexpr double kHardBrake = -0.3;           // of `drive`, and below
constexpr double kSlowestSparks = 0.3;        // rad/s
constexpr dvec3 kRingPlace(0.0, 2.2, 0.0);    // from the foot of its post, metres
constexpr dvec3 kBrakePlace(0.0, 0.14, 3.02); // from the carousel's middle: under its rim
const dvec3 kVertical(0.0, 1.0, 0.0);
const dvec3 kAhead(0.0, 0.0, 1.0);

} // namespace

core::Result<std::unique_ptr<Demo>> SpinDemo::create(scene::World world, std::string_view file) {
    NodeNames names(world);
    const auto part = [&](ecs::Entity entity) {
        const auto* rest = std::as_const(world).registry.find<scene::LocalTransform>(entity);
        return Part{entity, rest ? rest->transform : math::Transform{}};
    };
    Parts parts;
    parts.carousel = part(names.find("carousel"));
    parts.fan = part(names.find("fan"));
    parts.mill = part(names.find("mill"));
    parts.front = part(names.find("front"));
    parts.hub = names.find("hub");
    parts.ring = names.find("ring");
    (void)names.find("seat_0"); // the golden one
    SHUTTER_TRY(names.check(file));
    if (world.cameras.empty())
        return core::makeError("{}: it has no camera", file);
    for (const ecs::Entity seat : names.findAll("seat_"))
        parts.seats.push_back(part(seat));
    return std::unique_ptr<Demo>(new SpinDemo(std::move(world), std::move(parts)));
}

SpinDemo::SpinDemo(scene::World loaded, Parts parts)
    : DemoBase(std::move(loaded), parts.hub), mParts(std::move(parts)) {
    const auto add = [&](const Part& part) { (void)game::simulate(world(), part.entity); };
    add(mParts.carousel);
    add(mParts.fan);
    add(mParts.mill);
    add(mParts.front);
    for (const Part& seat : mParts.seats)
        add(seat);
    mRingSparks = addEmitter(mParts.ring, kRingPlace, makeSparks(1));
    mBrakeSparks = addEmitter(
        ecs::kNullEntity, mParts.carousel.rest.translation + kBrakePlace, makeBrakeSparks(2)
    );
    mRide.rate = 0.6; // it is turning when the game begins
    placeParts();
    recordStart();
}

ecs::Entity
SpinDemo::addEmitter(ecs::Entity parent, const dvec3& place, particles::ParticleEmitter emitter) {
    ecs::Registry& registry = world().registry;
    const ecs::Entity entity = registry.create();
    registry.add(entity, scene::LocalTransform{{.translation = place}});
    if (parent != ecs::kNullEntity)
        registry.add(entity, scene::Parent{parent});
    particles::addEmitter(registry, entity, std::move(emitter));
    return entity;
}

void SpinDemo::placeParts() {
    ecs::Registry& registry = world().registry;
    const auto place = [&](const Part& part, const dvec3& translation, const dquat& turn) {
        auto& pose = registry.get<SimulatedPose>(part.entity).transform;
        pose.translation = translation;
        pose.rotation = turn * part.rest.rotation;
    };
    place(
        mParts.carousel, mParts.carousel.rest.translation, glm::angleAxis(mRide.carousel, kVertical)
    );
    place(mParts.fan, mParts.fan.rest.translation, glm::angleAxis(-mRide.fan, kAhead));
    place(mParts.mill, mParts.mill.rest.translation, glm::angleAxis(-mRide.mill, kAhead));
    for (size_t i = 0; i < mParts.seats.size(); ++i) {
        const Part& seat = mParts.seats[i];
        // Neighbours rise and sink by turns.
        const double phase =
            kBobsPerTurn * mRide.carousel + std::numbers::pi * static_cast<double>(i % 2);
        place(
            seat,
            seat.rest.translation + kVertical * (kBob * std::sin(phase)),
            dquat(1.0, 0.0, 0.0, 0.0)
        );
    }
    const dquat round = glm::angleAxis(mOrbit, kVertical);
    const dvec3 middle = mParts.carousel.rest.translation;
    place(mParts.front, middle + round * (mParts.front.rest.translation - middle), round);
}

void SpinDemo::simulate(const DemoControls& controls) {
    constexpr double dt = kDemoStepSeconds;
    const bool wasOver = isOver();
    // After the end the ride runs down.
    stepRide(mRide, wasOver ? DemoControls{.drive = -0.15} : controls);
    mOrbit = std::clamp(mOrbit + controls.turn * kOrbitRate * dt, -kMaxOrbit, kMaxOrbit);
    placeParts();
    // Seat 0 faces the ring, which is at +Z, at angle 0.
    const bool isBraking = !wasOver && controls.drive <= kHardBrake && mRide.rate >= kSlowestSparks;
    emitSteadily(
        world().registry, mBrakeSparks, seconds(), isBraking ? kBrakeSparksPerSecond : 0.0
    );
    if (wasOver)
        return;
    const int caught = mRules.caught;
    stepRules(mRules, mRide, mRide.carousel, controls.action, mRandom);
    if (mRules.caught > caught)
        burst(world().registry, mRingSparks, seconds(), kSparksPerRing);
}

DemoAppearance SpinDemo::appearance() const {
    return {{0.34f, 0.55f, 0.86f}, {0.40f, 0.40f, 0.42f}, 2.0, 2.0};
}

bool SpinDemo::isOver() const {
    return seconds() > kRideSeconds;
}

std::vector<HudLine> SpinDemo::hud() const {
    const HudLine rings{fmt::format(
        "{} caught, {} missed",
        core::countOf(mRules.caught, "ring"),
        core::countOf(mRules.missed, "grab")
    )};
    if (isOver())
        return {{"The ride is over", true}, {fmt::format("{}", score()), true, "Score"}, rings};
    constexpr double kPerMinute = 30.0 / std::numbers::pi;
    const bool isKept = std::abs(mRide.rate - mRules.targetRate) <= kRateTolerance;
    return {
        {fmt::format("{}", score()), true, "Score"},
        {fmt::format("{:.1f} s", std::max(kRideSeconds - seconds(), 0.0)), false, "Left"},
        {fmt::format("{:.1f}", mRide.rate * kPerMinute), isKept, "Turns a minute"},
        {fmt::format("{:.1f}", mRules.targetRate * kPerMinute), isKept, isKept ? "Kept" : "Keep"},
        rings};
}

} // namespace shutter::game
