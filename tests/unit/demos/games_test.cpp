// SPDX-License-Identifier: MIT
// The rules of the three games.
#include "engine/scene/history.h"
#include "game/demos/gallery_aim.h"
#include "game/demos/gallery_balls.h"
#include "game/demos/gallery_targets.h"
#include "game/demos/rally_car.h"
#include "game/demos/rally_posts.h"
#include "game/demos/rally_track.h"
#include "game/demos/sparks.h"
#include "game/demos/spin_ride.h"
#include "game/demos/stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace shutter::game {
namespace {

using math::dvec2;
using math::dvec3;

class Gallery : public testing::Test {
  protected:
    ecs::Entity addTarget(const dvec3& rail, double speed) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, SimulatedPose{});
        Target target;
        target.rail = rail;
        target.halfLength = 4.0;
        target.slowest = 3.0;
        target.fastest = 6.0;
        target.speed = speed;
        mWorld.registry.add(entity, target);
        return entity;
    }

    ecs::Entity addBall() {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, SimulatedPose{});
        mWorld.registry.add(entity, Ball{});
        scene::hide(mWorld, entity);
        return entity;
    }

    [[nodiscard]] const Target& target(ecs::Entity entity) const {
        return mWorld.registry.get<Target>(entity);
    }

    [[nodiscard]] const SimulatedPose& pose(ecs::Entity entity) const {
        return mWorld.registry.get<SimulatedPose>(entity);
    }

    void runTargets(double seconds) {
        for (int i = 0; i < std::lround(seconds * kDemoStepsPerSecond); ++i)
            stepTargets(mWorld.registry, mRandom);
    }

    scene::World mWorld;
    Random mRandom{5};
};

TEST_F(Gallery, TargetsCrossAndComeInAgainByAJump) {
    const ecs::Entity entity = addTarget({0, 1, -5}, 5.0);
    runTargets(0.5);
    EXPECT_NEAR(pose(entity).transform.translation.x, 2.5, 1e-9);
    EXPECT_FALSE(pose(entity).jumped);
    runTargets(0.4);
    EXPECT_TRUE(pose(entity).jumped);
    EXPECT_LT(pose(entity).transform.translation.x, 0.0);
    EXPECT_GE(target(entity).speed, 3.0);
    EXPECT_LE(target(entity).speed, 6.0);
}

TEST_F(Gallery, AHitIsWorthTheTargetsSpeedOnceAndKnocksItOver) {
    const ecs::Entity entity = addTarget({0, 1, -5}, -5.5);
    const dvec3 face(0.0, 1.5, -5.0);
    EXPECT_FALSE(hitTarget(mWorld.registry, face + dvec3(0, 0, 0.3), 0.1)) << "before it";
    EXPECT_FALSE(hitTarget(mWorld.registry, face + dvec3(0.5, 0, 0), 0.1)) << "next to it";
    const auto hit = hitTarget(mWorld.registry, face + dvec3(0.2, 0.1, 0.1), 0.1);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->target, entity);
    EXPECT_EQ(pointsFor(*hit), 55);
    EXPECT_FALSE(hitTarget(mWorld.registry, face, 0.1)) << "it is down";
    runTargets(0.3);
    EXPECT_GT(target(entity).fall, 1.4);
    runTargets(3.0);
    EXPECT_EQ(target(entity).fall, 0.0) << "it has come in again";
}

TEST_F(Gallery, BallsBounceLoseEnergyAndArePickedUp) {
    // 24 m/s in a step against the depth in which a ball meets a face: it cannot pass through one.
    EXPECT_LT(24.0 * kDemoStepSeconds, 2.0 * (0.025 + kBallRadius));
    const ecs::Entity entity = addBall();
    throwBall(mWorld, {0, 1.5, 0}, {3, 2, -24}, 0.0);
    EXPECT_FALSE(scene::isHidden(mWorld, entity));
    EXPECT_TRUE(pose(entity).jumped);
    const auto energy = [&] {
        return measureEnergy(
            std::as_const(mWorld).registry.get<Ball>(entity), pose(entity).transform.translation.y
        );
    };
    const double first = energy();
    double most = first;
    const BallRoom room;
    for (int i = 0; i < kDemoStepsPerSecond * 4; ++i) {
        stepBalls(mWorld, room);
        most = std::max(most, energy());
        const dvec3 place = pose(entity).transform.translation;
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_GE(place[axis], room.low[axis]);
            ASSERT_LE(place[axis], room.high[axis]);
        }
    }
    EXPECT_LE(most, first + 0.5) << "beyond the rounding of one step";
    EXPECT_LT(energy(), 0.2 * first);
    for (int i = 0; i < kDemoStepsPerSecond * 2; ++i)
        stepBalls(mWorld, room);
    EXPECT_TRUE(scene::isHidden(mWorld, entity));
}

TEST_F(Gallery, TheOldestBallIsThrownAgainIfAllFlyAndNothingHappensWithoutBalls) {
    throwBall(mWorld, {0, 1, 0}, {0, 0, -20}, 0.0);
    const ecs::Entity first = addBall();
    const ecs::Entity second = addBall();
    throwBall(mWorld, {0, 1, 0}, {0, 0, -20}, 0.0);
    stepBalls(mWorld, {});
    throwBall(mWorld, {0, 1, 0}, {0, 0, -20}, 0.1);
    stepBalls(mWorld, {});
    const auto age = [&](ecs::Entity entity) {
        return std::as_const(mWorld).registry.get<Ball>(entity).seconds;
    };
    EXPECT_GT(age(first), age(second));
    throwBall(mWorld, {0, 1, 0}, {0, 0, -20}, 0.2);
    EXPECT_EQ(age(first), 0.0);
}

TEST(Aim, RecoilKicksAndDecaysAndAimStaysWithinItsBoundsAndTurnsToTheRight) {
    Aim aim;
    kickBack(aim);
    double most = 0.0;
    for (int i = 0; i < kDemoStepsPerSecond; ++i) {
        stepAim(aim, {});
        most = std::max(most, aim.recoil);
    }
    EXPECT_GT(most, 0.02);
    EXPECT_LT(most, 0.2);
    EXPECT_NEAR(aim.recoil, 0.0, 1e-3);
    EXPECT_NEAR(aim.kick, 0.0, 1e-3);
    Aim turned;
    for (int i = 0; i < kDemoStepsPerSecond * 3; ++i)
        stepAim(turned, {.turn = 1.0, .drive = 1.0});
    EXPECT_EQ(turned.yaw, kMaxYaw);
    EXPECT_EQ(turned.pitch, kMaxPitch);
    const dvec3 ahead = aimPose(turned, {}).rotation * dvec3(0, 0, -1);
    EXPECT_GT(ahead.x, 0.5);
    EXPECT_GT(ahead.y, 0.3);
}

constexpr DemoControls kThrottle{.drive = 1.0};
constexpr DemoControls kBrake{.drive = -1.0};

void drive(CarState& car, const DemoControls& controls, double seconds, bool onRoad = true) {
    for (int i = 0; i < std::lround(seconds * kDemoStepsPerSecond); ++i)
        stepCar(car, controls, onRoad);
}

TEST(RallyCar, FullThrottleReachesItsMostSpeedStraightAheadAndTheMeadowSlowsIt) {
    CarState car;
    drive(car, kThrottle, 2.0);
    EXPECT_GT(car.speed(), 15.0);
    drive(car, kThrottle, 28.0);
    EXPECT_NEAR(car.speed(), kCarMostSpeed, 0.5);
    EXPECT_EQ(car.place.x, 0.0);
    EXPECT_LT(car.place.y, -600.0);
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

TEST(RallyCar, EnergyNeverGrowsWithoutThrottle) {
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

TEST(RallyCar, SteeringTurnsToTheRequestedSideWithinGrip) {
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

TEST(RallyCar, TheHandBrakeLocksTheRearWheelsAndTheCarSlides) {
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

TEST(RallyTrack, GatesCountInTheirDirectionAndWidthOnlyAndRoadAndMeadowAreDistinguished) {
    const RallyTrack track = makeSquare();
    for (const Gate& each : track.gates())
        EXPECT_NEAR(track.measureDistance(each.place), 0.0, 1e-9);
    EXPECT_TRUE(track.isOnRoad({4.0, 0.0}));
    EXPECT_FALSE(track.isOnRoad({30.0, -30.0}));
    const Gate gate{{10, 5}, {0, -1}};
    EXPECT_TRUE(passesGate(gate, {10, 6}, {10, 4}));
    EXPECT_FALSE(passesGate(gate, {10, 4}, {10, 6})) << "backwards";
    EXPECT_FALSE(passesGate(gate, {17, 6}, {17, 4})) << "next to it";
    EXPECT_FALSE(passesGate(gate, {10, 8}, {10, 6})) << "not there yet";
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
    EXPECT_EQ(hitPosts(registry, car, 0.0), 0);
    car.place = {0.0, -3.2};
    EXPECT_EQ(hitPosts(registry, car, 0.0), 1);
    EXPECT_EQ(hitPosts(registry, car, 0.0), 0) << "it counts once";
    const Rod thrown = std::as_const(registry).get<Post>(entity).rod;
    // A post has a two-hundredth of the car's mass.
    EXPECT_LT(measureEnergy(thrown) - 9.81 * 0.55, 200.0 * 0.5 * (400.0 - 19.4 * 19.4));
    for (int i = 0; i < 120 * 20; ++i)
        stepPosts(registry);
    const Post& post = std::as_const(registry).get<Post>(entity);
    EXPECT_TRUE(post.rod.asleep);
    EXPECT_LT(post.rod.place.z, -6.0);
    EXPECT_LT(std::abs((post.rod.rotation * dvec3(0, 1, 0)).y), 0.3) << "it lies";
    EXPECT_EQ(
        std::as_const(registry).get<SimulatedPose>(entity).transform.translation, post.rod.place
    );
}

TEST(Rod, EnergyDoesNotGrowAndTheRodComesToRest) {
    for (const double spin : {-8.0, 0.5, 14.0}) {
        Rod rod;
        rod.place = {0.0, 1.5, 0.0};
        rod.velocity = {3.0, 2.0, -9.0};
        rod.spin = {spin, 0.3 * spin, 0.7};
        double before = measureEnergy(rod);
        for (int i = 0; i < 120 * 20; ++i) {
            stepRod(rod);
            // Being pushed out of the ground lifts it by its penetration in one step.
            ASSERT_LE(measureEnergy(rod), before + 0.12 + 0.01 * before) << i;
            before = std::min(before, measureEnergy(rod));
            ASSERT_GE(rod.place.y, 0.0);
        }
        EXPECT_TRUE(rod.asleep);
    }
}

TEST(ChaseCamera, TheCameraComesToRestBehindTheCarWithoutSwinging) {
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

constexpr double kPi = std::numbers::pi;

TEST(Ride, ARideSpeedsUpBrakesAndStopsAtItsBoundsAndItsGearsTurnTogether) {
    Ride ride;
    for (int i = 0; i < kDemoStepsPerSecond * 10; ++i)
        stepRide(ride, {.drive = 1.0});
    EXPECT_EQ(ride.rate, kMaxRideRate);
    for (int i = 0; i < kDemoStepsPerSecond * 10; ++i)
        stepRide(ride, {.drive = -1.0});
    EXPECT_EQ(ride.rate, 0.0);
    Ride idle{.rate = 2.0};
    double before = idle.rate;
    for (int i = 0; i < kDemoStepsPerSecond; ++i) {
        stepRide(idle, {});
        ASSERT_LT(idle.rate, before);
        before = idle.rate;
    }
    Ride geared{.rate = 2.0};
    stepRide(geared, {});
    EXPECT_NEAR(geared.fan, kFanGear * geared.carousel, 1e-12);
    EXPECT_NEAR(wrapAngle(geared.mill), kMillGear * geared.carousel, 1e-12);
    EXPECT_LT(kMaxRideRate * kFanGear * kDemoStepSeconds, kPi);
}

TEST(RideRules, KeepingTheRateScoresByTheSecond) {
    Random random(1);
    RideRules near;
    RideRules far;
    for (int i = 0; i < kDemoStepsPerSecond; ++i) {
        stepRules(near, {.rate = near.targetRate + 0.9 * kRateTolerance}, 1.0, false, random);
        stepRules(far, {.rate = far.targetRate + 1.1 * kRateTolerance}, 1.0, false, random);
    }
    EXPECT_NEAR(near.matched, 20.0, 1e-6);
    EXPECT_EQ(far.matched, 0.0);
}

TEST(RideRules, ARingIsCaughtOncePerGrabAndAMissCosts) {
    Random random(1);
    RideRules rules{.targetRate = 9.0};
    const Ride ride{.rate = 2.0};
    stepRules(rules, ride, 0.1, true, random);
    stepRules(rules, ride, 0.1, true, random);
    EXPECT_EQ(rules.caught, 1) << "held on is not grabbed again";
    stepRules(rules, ride, 0.1, false, random);
    stepRules(rules, ride, 2.0 * kPi - 0.1, true, random);
    EXPECT_EQ(rules.caught, 2) << "just before the ring";
    EXPECT_EQ(countPoints(rules), 160);
    stepRules(rules, ride, 0.1, false, random);
    stepRules(rules, ride, kPi, true, random);
    EXPECT_EQ(rules.missed, 1);
    EXPECT_EQ(countPoints(rules), 145);
}

TEST(RideRules, AnotherRateIsDemandedEveryNineSeconds) {
    Random random(1);
    RideRules rules;
    std::set<double> rates;
    for (int i = 0; i < kDemoStepsPerSecond * 44; ++i) {
        stepRules(rules, {}, 1.0, false, random);
        rates.insert(rules.targetRate);
        ASSERT_GT(rules.targetRate, 0.5);
        ASSERT_LT(rules.targetRate, kMaxRideRate - kRateTolerance);
    }
    EXPECT_EQ(rates.size(), 5u);
}

TEST(WrapAngle, WholeTurnsAreRemoved) {
    EXPECT_NEAR(wrapAngle(2.0 * kPi + 0.3), 0.3, 1e-12);
    EXPECT_NEAR(wrapAngle(-0.3), -0.3, 1e-12);
    EXPECT_NEAR(wrapAngle(1.5 * kPi), -0.5 * kPi, 1e-12);
    EXPECT_NEAR(wrapAngle(kPi), -kPi, 1e-12);
}

TEST(Sparks, StepsThatFollowOneAnotherAreOneSpanAndWhatIsGoneIsDropped) {
    ecs::Registry registry;
    const ecs::Entity wheel = registry.create();
    registry.add(wheel, makeDust(1));
    const auto& dust = registry.get<particles::ParticleEmitter>(wheel);
    double seconds = 0.0;
    const auto run = [&](int steps, double perSecond) {
        for (int i = 0; i < steps; ++i)
            emitSteadily(registry, wheel, seconds += kDemoStepSeconds, perSecond);
    };
    run(10, 70.0);
    ASSERT_EQ(dust.spans.size(), 1u);
    EXPECT_NEAR(dust.spans[0].fromSeconds, 0.0, 1.0e-12);
    EXPECT_EQ(dust.spans[0].untilSeconds, seconds);
    run(1, 0.0);
    run(2, 70.0);
    EXPECT_EQ(dust.spans.size(), 2u);
    EXPECT_TRUE(particles::validateEmitter(dust).ok());
    run(1000, 0.0);
    EXPECT_TRUE(dust.spans.empty());
}

TEST(Sparks, AllThatTheDemosEmitIsValidAndSparksOfHitPostsFlyOnce) {
    for (const auto& make : {makeSparks, makeBrakeSparks, makeDust, makeSplinters, makeFlash})
        EXPECT_TRUE(particles::validateEmitter(make(3)).ok());
    ecs::Registry registry;
    const ecs::Entity post = registry.create();
    registry.add(post, Post{});
    registry.add(post, makeSparks(1));
    CarState car;
    car.velocity = {0.0, -10.0};
    for (const double seconds : {1.0, 1.1})
        (void)hitPosts(registry, car, seconds);
    const auto& sparks = registry.get<particles::ParticleEmitter>(post);
    ASSERT_EQ(sparks.bursts.size(), 1u);
    EXPECT_EQ(sparks.bursts[0].seconds, 1.0);
    EXPECT_GT(particles::listLiving(sparks, 1.0, 1.1).value().size(), 10u);
}

} // namespace
} // namespace shutter::game
