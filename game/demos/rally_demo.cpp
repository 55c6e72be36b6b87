// SPDX-License-Identifier: MIT
#include "game/demos/rally_demo.h"

#include "engine/core/words.h"
#include "game/demos/rally_posts.h"
#include "game/demos/sparks.h"
#include "game/demos/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace shutter::game {

namespace {

constexpr int kLaps = 2;
constexpr double kTimeLimit = 120.0; // s
constexpr double kParSeconds = 90.0; // each second below it is worth kPerSecond
constexpr int kPerSecond = 20;
constexpr int kPerGate = 100;
constexpr int kPerPost = -50;

constexpr double kSlidingSpeed = 1.8; // m/s sideways, from which tyres raise dust
constexpr double kDustySpeed = 6.0;   // m/s off the road
constexpr double kDustPerSecond = 70.0;

void addPosts(scene::World& world, const std::vector<ecs::Entity>& entities) {
    uint32_t seed = 1;
    for (const ecs::Entity entity : entities) {
        Post post;
        post.rod.place = simulate(world, entity).transform.translation;
        world.registry.add(entity, post);
        particles::addEmitter(world.registry, entity, makeSparks(seed++));
    }
}

} // namespace

core::Result<std::unique_ptr<Demo>> RallyDemo::create(scene::World world, std::string_view file) {
    NodeNames names(world);
    Nodes nodes;
    nodes.car = names.find("car");
    nodes.body = names.find("car_body");
    nodes.chase = names.find("chase");
    static constexpr std::array kWheels = {"front_left", "front_right", "rear_left", "rear_right"};
    for (size_t i = 0; i < kWheels.size(); ++i)
        nodes.wheels[i] = {
            names.find(std::string("wheel_") + kWheels[i]),
            names.find(std::string("spokes_") + kWheels[i]),
            {},
            i < 2};
    (void)names.find("gate_02"); // a track has three gates at least
    SHUTTER_TRY(names.check(file));
    if (world.cameras.empty())
        return core::makeError("{}: it has no camera", file);
    for (Wheel& wheel : nodes.wheels)
        wheel.rest = restOf(world, wheel.tyre);
    std::vector<Gate> gates;
    for (const ecs::Entity gate : names.findAll("gate_"))
        gates.push_back(readGate(restOf(world, gate)));
    if (gates.size() < 3)
        return core::makeError(
            "{}: it has {}, a track needs three", file, core::countOf(gates.size(), "gate")
        );
    std::vector<Fence> fences;
    for (const ecs::Entity fence : names.findAll("fence_"))
        fences.push_back(readFence(restOf(world, fence)));
    addPosts(world, names.findAll("post_"));
    return std::unique_ptr<Demo>(
        new RallyDemo(std::move(world), nodes, RallyTrack(std::move(gates)), std::move(fences))
    );
}

RallyDemo::RallyDemo(
    scene::World loaded, const Nodes& nodes, RallyTrack track, std::vector<Fence> fences
)
    : DemoBase(std::move(loaded), nodes.body), mCar(nodes.car), mNodes(nodes),
      mBodyRest(restOf(world(), nodes.body)), mTrack(std::move(track)), mFences(std::move(fences)) {
    const Gate& start = mTrack.gates().front();
    CarState car;
    car.heading = std::atan2(-start.direction.x, -start.direction.y);
    // Before the line, so that it is passed when the race begins.
    car.place = start.place - start.direction * 8.0;
    mChase.heading = car.heading;
    world().registry.add(mCar, car);
    for (const ecs::Entity entity : {mCar, mNodes.body, mNodes.chase})
        (void)game::simulate(world(), entity);
    for (const Wheel& wheel : mNodes.wheels) {
        (void)game::simulate(world(), wheel.tyre);
        (void)game::simulate(world(), wheel.spokes);
        // Wheels blur by their own motion, independent of the body's scale.
        world().registry.add(wheel.tyre, scene::MotionBlur{});
        if (!wheel.isFront)
            particles::addEmitter(
                world().registry, wheel.tyre, makeDust(static_cast<uint32_t>(wheel.tyre.index))
            );
    }
    placeCar();
    recordStart();
}

void RallyDemo::placeCar() {
    ecs::Registry& registry = world().registry;
    const CarState state = car();
    const auto place = [&](ecs::Entity entity, const math::Transform& pose) {
        registry.get<SimulatedPose>(entity).transform = pose;
    };
    place(mCar, carPose(state));
    place(mNodes.body, bodyPose(state, mBodyRest));
    for (const Wheel& wheel : mNodes.wheels) {
        place(wheel.tyre, wheelPose(state, wheel.rest, wheel.isFront));
        place(wheel.spokes, spokesPose(state, wheel.isFront));
    }
    place(mNodes.chase, chasePose(mChase, state));
}

void RallyDemo::raiseDust(const CarState& state) {
    const double slip = std::abs(glm::dot(state.velocity, state.right()));
    const bool isOff = !mTrack.isOnRoad(state.place) && glm::length(state.velocity) > kDustySpeed;
    for (const Wheel& wheel : mNodes.wheels)
        if (!wheel.isFront)
            emitSteadily(
                world().registry,
                wheel.tyre,
                seconds(),
                slip > kSlidingSpeed || isOff ? kDustPerSecond : 0.0
            );
}

void RallyDemo::simulate(const DemoControls& controls) {
    auto& state = world().registry.get<CarState>(mCar);
    const math::dvec2 before = state.place;
    // After the race the car rolls out.
    const DemoControls rollOut{.drive = state.speed() > 0.5 ? -0.4 : 0.0};
    stepCar(state, isOver() ? rollOut : controls, mTrack.isOnRoad(state.place));
    (void)collideWithFences(state, mFences);
    const int hits = hitPosts(world().registry, state, seconds());
    raiseDust(state);
    stepPosts(world().registry);
    stepChase(mChase, state);
    placeCar();
    if (isOver())
        return;
    mPostsHit += hits;
    (void)advance(mProgress, mTrack, before, state.place);
    if (mProgress.lap >= kLaps || seconds() >= kTimeLimit)
        mEndSeconds = seconds();
}

DemoAppearance RallyDemo::appearance() const {
    return {{0.30f, 0.52f, 0.86f}, {0.34f, 0.38f, 0.44f}, 2.2, 2.0};
}

bool RallyDemo::isOver() const {
    return mEndSeconds > 0.0;
}

int RallyDemo::score() const {
    const bool isFinished = mProgress.lap >= kLaps;
    const double early = isFinished ? std::max(kParSeconds - mEndSeconds, 0.0) : 0.0;
    return kPerGate * mProgress.gatesPassed + kPerPost * mPostsHit +
           static_cast<int>(kPerSecond * early);
}

std::vector<HudLine> RallyDemo::hud() const {
    if (isOver())
        return {
            {mProgress.lap >= kLaps ? "Finish" : "Out of time", true},
            {fmt::format("{}", score()), true, "Score"},
            {fmt::format(
                 "{:.1f} s, {}, {} knocked over",
                 mEndSeconds,
                 core::countOf(mProgress.gatesPassed, "gate"),
                 core::countOf(mPostsHit, "post")
             ),
             false}};
    return {
        {fmt::format("{}", score()), true, "Score"},
        {fmt::format("{}/{}", mProgress.lap + 1, kLaps), false, "Lap"},
        {fmt::format("{:.1f} s", seconds()), false, "Time"},
        {fmt::format("{:.0f} km/h", std::abs(car().speed()) * 3.6), false, "Speed"},
        {fmt::format(
            "{}, {} knocked over",
            core::countOf(mProgress.gatesPassed, "gate"),
            core::countOf(mPostsHit, "post")
        )}};
}

} // namespace shutter::game
