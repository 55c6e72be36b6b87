// SPDX-License-Identifier: MIT
#include "game/demos/rally_car.h"
#include "game/demos/rally_posts.h"
#include "game/demos/rally_track.h"
#include "game/demos/stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace shutter::game {
namespace {

using math::dvec2;
using math::dvec3;

constexpr DemoControls kThrottle{.drive = 1.0};
constexpr DemoControls kBrake{.drive = -1.0};

void drive(CarState& car, const DemoControls& controls, double seconds, bool onRoad = true) {
    for (int i = 0; i < std::lround(seconds * kDemoStepsPerSecond); ++i)
        stepCar(car, controls, onRoad);
}

TEST(RallyCar, FullThrottleReachesItsMostSpeedStraightAhead) {
    CarState car;
    drive(car, kThrottle, 2.0);
    EXPECT_GT(car.speed(), 15.0);
    drive(car, kThrottle, 28.0);
    EXPECT_NEAR(car.speed(), kCarMostSpeed, 0.5);
    EXPECT_EQ(car.place.x, 0.0);
    EXPECT_LT(car.place.y, -600.0);
}

TEST(RallyCar, TheMeadowSlowsItAndTheRoadDoesNotStopIt) {
    CarState road;
    CarState meadow;
    drive(road, kThrottle, 10.0);
    drive(meadow, kThrottle, 10.0, false);
    EXPECT_LT(meadow.speed(), 0.8 * road.speed());
    EXPECT_GT(meadow.speed(), 3.0);
}

TEST(RallyCar, BrakesStopItWithinTheirDeceleration) {
    CarState car;
    car.velocity = {0.0, -26.0};
    int steps = 0;
    for (; car.speed() > 0.0 && steps < 10 * kDemoStepsPerSecond; ++steps)
        stepCar(car, kBrake, true);
    EXPECT_LE(steps * kDemoStepSeconds, 26.0 / kCarBrakeDecel + kDemoStepSeconds);
    EXPECT_LT(-car.place.y, 26.0 * 26.0 / (2.0 * kCarBrakeDecel));
    drive(car, kBrake, 1.0);
    EXPECT_LT(car.speed(), -1.0) << "then it backs up";
}

TEST(RallyCar, WithoutThrottleItsEnergyNeverGrows) {
    for (const bool handBrake : {false, true})
        for (const double turn : {-1.0, 0.0, 0.4}) {
            CarState car;
            car.velocity = {4.0, -22.0};
            double before = glm::length(car.velocity);
            for (int i = 0; i < 600; ++i) {
                stepCar(car, {.turn = turn, .action = handBrake}, i % 50 < 25);
                ASSERT_LE(glm::length(car.velocity), before + 1e-12) << i;
                before = glm::length(car.velocity);
            }
        }
}

TEST(RallyCar, SteersToTheSideThatIsAskedForWithinItsGrip) {
    CarState car;
    car.velocity = {0.0, -15.0};
    const DemoControls right{.turn = 1.0, .drive = 0.5};
    double before = car.heading;
    for (int i = 0; i < 120; ++i) {
        stepCar(car, right, true);
        const double turnRate = (before - car.heading) * kDemoStepsPerSecond;
        before = car.heading;
        ASSERT_LE(turnRate * std::max(car.speed(), 1.0), 1.15 * 9.81 + 1e-3) << i;
    }
    EXPECT_GT(car.place.x, 1.0);
    EXPECT_LT(car.heading, -0.3);
}

TEST(RallyCar, TheHandBrakeLocksTheRearWheelsAndLetsItSlide) {
    CarState gripping;
    gripping.velocity = {0.0, -18.0};
    CarState sliding = gripping;
    drive(gripping, {.turn = 1.0}, 0.6);
    drive(sliding, {.turn = 1.0, .action = true}, 0.6);
    const auto slip = [](const CarState& car) {
        return std::abs(glm::dot(car.velocity, car.right()));
    };
    EXPECT_EQ(sliding.rearRoll, 0.0);
    EXPECT_GT(sliding.frontRoll, 0.0);
    EXPECT_GT(slip(sliding), slip(gripping) + 0.5);
}

TEST(RallyCar, WheelsRollForwardOnTheGround) {
    CarState car;
    car.velocity = {0.0, -10.0};
    const math::Transform rest{{0.8, kWheelRadius, -1.2}};
    const auto turnOf = [&] {
        return wheelPose(car, rest, true).rotation * spokesPose(car, true).rotation;
    };
    const dvec3 top = glm::inverse(turnOf()) * dvec3(0.0, kWheelRadius, 0.0);
    stepCar(car, {}, true);
    // The top runs ahead of the axle as fast as the axle over the ground.
    EXPECT_NEAR((turnOf() * top).z, -10.0 * kDemoStepSeconds, 2e-3);
    EXPECT_LT(kCarMostSpeed / kWheelRadius * kDemoStepSeconds, std::numbers::pi)
        << "a recorded step is less than half a turn";
}

RallyTrack makeSquare() {
    return RallyTrack(
        {{{0, 0}, {0, -1}}, {{0, -60}, {1, 0}}, {{60, -60}, {0, 1}}, {{60, 0}, {-1, 0}}}
    );
}

TEST(RallyTrack, GatesCountInTheirDirectionAndWidthOnly) {
    const Gate gate{{10, 5}, {0, -1}};
    EXPECT_TRUE(passesGate(gate, {10, 6}, {10, 4}));
    EXPECT_FALSE(passesGate(gate, {10, 4}, {10, 6})) << "backwards";
    EXPECT_FALSE(passesGate(gate, {17, 6}, {17, 4})) << "beside it";
    EXPECT_FALSE(passesGate(gate, {10, 8}, {10, 6})) << "not there yet";
}

TEST(RallyTrack, LapsCountAtTheFirstGateWhateverWasMissed) {
    const RallyTrack track = makeSquare();
    const auto pass = [&](RallyProgress& progress, size_t i) {
        const Gate& gate = track.gates()[i];
        return advance(progress, track, gate.place - gate.direction, gate.place + gate.direction);
    };
    RallyProgress all;
    EXPECT_FALSE(pass(all, 0)) << "the start is behind";
    for (const size_t gate : {1, 2, 3, 0})
        EXPECT_TRUE(pass(all, gate));
    EXPECT_EQ(all.lap, 1);
    EXPECT_EQ(all.gatesPassed, 4);

    RallyProgress missed;
    for (const size_t gate : {1, 3, 1})
        EXPECT_TRUE(pass(missed, gate));
    EXPECT_EQ(missed.lap, 1) << "gate 0 was missed, the lap is done all the same";
    EXPECT_EQ(missed.gatesPassed, 3);
}

TEST(RallyTrack, KnowsTheRoadFromTheMeadow) {
    const RallyTrack track = makeSquare();
    for (const Gate& gate : track.gates())
        EXPECT_NEAR(track.measureDistance(gate.place), 0.0, 1e-9);
    EXPECT_TRUE(track.isOnRoad({4.0, 0.0}));
    EXPECT_FALSE(track.isOnRoad({30.0, -30.0}));
}

TEST(RallyTrack, FencesHoldTheCarAndTakeItsSpeedAcross) {
    const std::array fences = {Fence{{2, 10}, {2, -10}}};
    CarState car;
    car.velocity = {6.0, -10.0};
    for (int i = 0; i < 120; ++i) {
        const double before = glm::length(car.velocity);
        car.place += car.velocity * kDemoStepSeconds;
        (void)collideWithFences(car, fences);
        ASSERT_LE(glm::length(car.velocity), before + 1e-12);
        ASSERT_LE(car.place.x, 2.0 - kCarHalfWidth + 1e-9);
    }
    EXPECT_LE(car.velocity.x, 0.0);
    EXPECT_LT(car.velocity.y, -5.0) << "it slides along";
    car.place = {2.0, 0.0};
    EXPECT_FALSE(collideWithFences(car, fences)) << "on the line itself there is no side";
    EXPECT_TRUE(std::isfinite(car.place.x));
}

TEST(RallyPosts, AHitPostIsThrownAndTheCarPaysForIt) {
    ecs::Registry registry;
    const ecs::Entity entity = registry.create();
    registry.add(entity, SimulatedPose{});
    Post standing;
    standing.rod.place = {0.3, 0.55, -5.0};
    registry.add(entity, standing);
    CarState car;
    car.velocity = {0.0, -20.0};
    EXPECT_EQ(hitPosts(registry, car), 0);
    car.place = {0.0, -3.2};
    EXPECT_EQ(hitPosts(registry, car), 1);
    EXPECT_EQ(hitPosts(registry, car), 0) << "it counts once";
    const Rod thrown = std::as_const(registry).get<Post>(entity).rod;
    // A post has a two-hundredth of the car's mass.
    EXPECT_LT(measureEnergy(thrown) - 9.81 * 0.55, 200.0 * 0.5 * (400.0 - 19.4 * 19.4));
    for (int i = 0; i < 120 * 20; ++i)
        stepPosts(registry);
    const Post& post = std::as_const(registry).get<Post>(entity);
    EXPECT_TRUE(post.rod.asleep);
    EXPECT_LT(post.rod.place.z, -6.0);
    const dvec3 axis = post.rod.rotation * dvec3(0, 1, 0);
    EXPECT_LT(std::abs(axis.y), 0.3) << "it lies";
    EXPECT_EQ(
        std::as_const(registry).get<SimulatedPose>(entity).transform.translation, post.rod.place
    );
}

TEST(Rod, ItsEnergyDoesNotGrowAndItComesToRest) {
    for (const double spin : {-8.0, 0.5, 14.0}) {
        Rod rod;
        rod.place = {0.0, 1.5, 0.0};
        rod.velocity = {3.0, 2.0, -9.0};
        rod.spin = {spin, 0.3 * spin, 0.7};
        double before = measureEnergy(rod);
        for (int i = 0; i < 120 * 20; ++i) {
            stepRod(rod);
            // Being pushed out of the ground lifts it by what it sank in one step.
            ASSERT_LE(measureEnergy(rod), before + 0.12 + 0.01 * before) << i;
            before = std::min(before, measureEnergy(rod));
            ASSERT_GE(rod.place.y, 0.0);
        }
        EXPECT_TRUE(rod.asleep);
    }
}

TEST(ChaseCamera, ComesToRestBehindTheCarWithoutSwinging) {
    CarState car;
    car.heading = 1.0;
    ChaseCamera camera;
    double before = 0.0;
    for (int i = 0; i < 600; ++i) {
        stepChase(camera, car);
        ASSERT_GE(camera.heading, before - 1e-12);
        before = camera.heading;
    }
    EXPECT_NEAR(camera.heading, 1.0, 1e-3);
    EXPECT_LE(camera.heading, 1.0 + 1e-9);
    const math::Transform pose = chasePose(camera, car);
    const dvec3 ahead = pose.rotation * dvec3(0, 0, -1);
    EXPECT_NEAR(glm::dot(dvec2(ahead.x, ahead.z), car.forward()), 1.0, 1e-5);
    EXPECT_LT(glm::dot(dvec2(pose.translation.x, pose.translation.z), car.forward()), -4.0);
}

} // namespace
} // namespace shutter::game
