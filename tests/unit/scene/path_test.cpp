// SPDX-License-Identifier: MIT
// Paths, also with targets straight down or up, or at the camera itself.
#include "engine/scene/motion.h"
#include "engine/scene/path.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace shutter::scene {
namespace {

using math::dmat3;
using math::dquat;
using math::dvec3;

PathKey key(double seconds, const dvec3& position) {
    PathKey made;
    made.seconds = seconds;
    made.position = position;
    return made;
}

PathKey turned(double seconds, double degrees) {
    PathKey made = key(seconds, dvec3(0.0));
    made.rotation = glm::angleAxis(degrees * std::numbers::pi / 180.0, kUp);
    return made;
}

constexpr PathInterpolation kBoth[] = {PathInterpolation::Linear, PathInterpolation::CatmullRom};

PathMotion makePath(
    std::vector<PathKey> keys, PathInterpolation interpolation = PathInterpolation::CatmullRom
) {
    PathMotion path;
    path.keys = std::move(keys);
    path.interpolation = interpolation;
    return path;
}

PathMotion curve() {
    return makePath(
        {key(0.0, {0, 0, 0}), key(1.0, {1, 2, 0}), key(1.5, {4, 2, 1}), key(4.0, {4, -1, 3})}
    );
}

dvec3 placeAt(const PathMotion& path, double seconds) {
    return samplePath(path, {}, seconds).translation;
}

dvec3 forwardAt(const PathMotion& path, double seconds) {
    return samplePath(path, {}, seconds).rotation * dvec3(0.0, 0.0, -1.0);
}

/// A vector of the path changes without a jump, and its velocity as well.
void expectSmooth(const PathMotion& path, dvec3 (*vectorAt)(const PathMotion&, double)) {
    constexpr double kStep = 1e-5;
    for (double t = 0.01; t < path.keys.back().seconds - 0.01; t += 0.005) {
        const dvec3 now = vectorAt(path, t);
        const dvec3 before = (now - vectorAt(path, t - kStep)) / kStep;
        const dvec3 after = (vectorAt(path, t + kStep) - now) / kStep;
        ASSERT_LT(glm::length(after - before), 1e-2) << t;
    }
}

TEST(Path, APathPassesItsKeysAndStaysAtTheEnds) {
    for (const auto interpolation : kBoth)
        for (const auto ease : {PathEase::None, PathEase::InOut}) {
            PathMotion path = curve();
            path.interpolation = interpolation;
            path.ease = ease;
            EXPECT_EQ(placeAt(path, -3.0), path.keys.front().position);
            EXPECT_EQ(placeAt(path, 0.0), path.keys.front().position);
            EXPECT_EQ(placeAt(path, 4.0), path.keys.back().position);
            EXPECT_EQ(placeAt(path, 99.0), path.keys.back().position);
            if (ease == PathEase::InOut)
                continue;
            for (const PathKey& each : path.keys)
                expectNear(placeAt(path, each.seconds), each.position);
        }
}

TEST(Path, TheCurveIsContinuousAndSoIsItsVelocityAndEaseStartsAndStopsFromRest) {
    expectSmooth(curve(), placeAt);
    PathMotion path = curve();
    path.ease = PathEase::InOut;
    expectSmooth(path, placeAt);
    path.keys = {key(0, {0, 0, 0}), key(2, {1, 0, 0})};
    EXPECT_NEAR(placeAt(path, 1.0).x, 0.5, 1e-12);
    EXPECT_NEAR(placeAt(path, 0.5).x, 0.15625, 1e-12); // 3 x^2 - 2 x^3 at a quarter
    EXPECT_LT(placeAt(path, 0.01).x, 1e-4);
    EXPECT_GT(placeAt(path, 1.99).x, 1.0 - 1e-4);
    path = makePath({key(0, {0, 0, 0}), key(1, {2, 0, 0}), key(2, {4, 0, 0}), key(3, {6, 0, 0})});
    for (double t = 0.0; t <= 3.0; t += 0.1)
        expectNear(placeAt(path, t), {2.0 * t, 0, 0}); // straight and even keys
}

TEST(Path, RotationsPassThroughTheirKeysSmoothlyTheShorterWay) {
    for (const auto interpolation : kBoth) {
        PathMotion path =
            makePath({turned(0, 0), turned(1, 90), turned(2, 200), turned(3, 350)}, interpolation);
        // The other sign is the same rotation.
        path.keys[2].rotation = -*path.keys[2].rotation;
        for (const PathKey& each : path.keys)
            expectNear(forwardAt(path, each.seconds), *each.rotation * dvec3(0, 0, -1));
        const dvec3 half = glm::angleAxis(45.0 * std::numbers::pi / 180.0, kUp) * dvec3(0, 0, -1);
        EXPECT_GT(glm::dot(forwardAt(path, 0.5), half), 0.99);
        for (double t = 0.0; t < 3.0; t += 0.01)
            ASSERT_GT(glm::dot(forwardAt(path, t), forwardAt(path, t + 0.01)), 0.999) << t;
        if (interpolation == PathInterpolation::CatmullRom)
            expectSmooth(path, forwardAt);
    }
}

TEST(Path, APathFacesItsTargetAndStaysUpright) {
    PathMotion path = curve();
    for (PathKey& each : path.keys)
        each.lookAt = dvec3(1, 0, -5) + 0.5 * each.seconds;
    for (double t = 0.0; t <= 4.0; t += 0.1) {
        const math::Transform pose = samplePath(path, {}, t);
        // The targets lie on a line at even speed, up to what their uneven times bend.
        const dvec3 target = dvec3(1, 0, -5) + 0.5 * t;
        const dvec3 forward = pose.rotation * dvec3(0, 0, -1);
        EXPECT_GT(glm::dot(forward, glm::normalize(target - pose.translation)), 0.9999) << t;
        EXPECT_NEAR((pose.rotation * dvec3(1, 0, 0)).y, 0.0, 1e-9) << "no roll";
        EXPECT_GT((pose.rotation * kUp).y, 0.0);
        EXPECT_NEAR(glm::length(pose.rotation), 1.0, 1e-9);
    }
}

TEST(Path, APathStaysAtTheKeyBeforeACutUntilIt) {
    PathMotion path =
        makePath({key(0, {0, 0, 0}), key(1, {1, 0, 0}), key(2, {50, 0, 0}), key(3, {51, 0, 0})});
    path.keys[2].cut = true;
    EXPECT_EQ(placeAt(path, 1.5), dvec3(1, 0, 0));
    EXPECT_EQ(placeAt(path, 1.999999), dvec3(1, 0, 0));
    EXPECT_EQ(placeAt(path, 2.0), dvec3(50, 0, 0));
    // Each shot is a separate curve: two keys are a straight line.
    expectNear(placeAt(path, 0.5), {0.5, 0, 0});
    expectNear(placeAt(path, 2.5), {50.5, 0, 0});
    EXPECT_TRUE(hasCutWithin(path, 1.5, 2.5));
    EXPECT_TRUE(hasCutWithin(path, 1.5, 2.0));
    EXPECT_FALSE(hasCutWithin(path, 2.0, 2.5)) << "over";
    EXPECT_FALSE(hasCutWithin(path, 0.0, 1.9));
}

/// A hold of two seconds between two ways, by each kind of direction.
std::vector<PathMotion> listHolds() {
    const PathMotion held = makePath(
        {key(0, {-3, 0, 5}), key(1, {0.1, 0.2, 5}), key(3, {0.1, 0.2, 5}), key(4, {3, 0, 5})}
    );
    std::vector<PathMotion> holds = {held, held, held};
    for (size_t i = 0; i < held.keys.size(); ++i) {
        holds[1].keys[i].lookAt = held.keys[i].position - dvec3(0.3, 0.7, 5);
        holds[2].keys[i].rotation =
            glm::angleAxis(held.keys[i].position.x, glm::normalize(dvec3(1, 2, 3)));
    }
    holds[2].keys[2].rotation = -*holds[2].keys[2].rotation; // the same
    return holds;
}

TEST(Path, TwoEqualKeysHoldStillToTheBit) {
    for (const auto interpolation : kBoth)
        for (const auto ease : {PathEase::None, PathEase::InOut})
            for (PathMotion& path : listHolds()) {
                path.interpolation = interpolation;
                path.ease = ease;
                const math::Transform there = samplePath(path, {}, 2.0);
                for (double t = 1.4; t < 2.6; t += 0.003) { // eased or not
                    const math::Transform pose = samplePath(path, {}, t);
                    EXPECT_EQ(pose.translation, there.translation) << t;
                    EXPECT_EQ(pose.rotation, there.rotation) << t;
                }
                EXPECT_NE(placeAt(path, 0.9), there.translation);
            }
}

TEST(Path, AHoldIsComeToAndLeftAtRestAndStaysStillAtAnEndOfAShotAndBeforeACut) {
    constexpr double kStep = 1e-5;
    for (const double from : {1.0 - kStep, 1.0, 3.0 - kStep, 3.0}) {
        const PathMotion held = listHolds()[0];
        EXPECT_LT(glm::distance(placeAt(held, from), placeAt(held, from + kStep)), 1e-8) << from;
    }
    PathMotion path = makePath(
        {key(0, {0, 0, 0}),
         key(1, {0, 0, 0}),
         key(2, {1, 1, 0}),
         key(3, {1, 1, 0}),
         key(4, {9, 0, 0}),
         key(5, {9, 0, 0}),
         key(6, {9, 5, 0})}
    );
    path.keys[4].cut = true;
    for (double t = 0.0; t < 1.0; t += 0.125) {
        EXPECT_EQ(placeAt(path, t), dvec3(0, 0, 0));
        EXPECT_EQ(placeAt(path, 2.0 + t), dvec3(1, 1, 0));
        EXPECT_EQ(placeAt(path, 3.0 + t), dvec3(1, 1, 0)) << "until the cut";
        EXPECT_EQ(placeAt(path, 4.0 + t), dvec3(9, 0, 0));
    }
    EXPECT_GT(placeAt(path, 5.5).y, 1.0);
}

TEST(Path, APathMovesItsEntityInTheParentsSpaceAndPreservesRotationAndScale) {
    World world;
    const ecs::Entity parent = world.registry.create();
    world.registry.add(parent, LocalTransform{{{10, 0, 0}, {1, 0, 0, 0}, dvec3(2.0)}});
    const ecs::Entity entity = world.registry.create();
    const math::Transform rest{{9, 9, 9}, glm::angleAxis(0.3, kUp), {2, 3, 4}};
    world.registry.add(entity, Parent{parent});
    world.registry.add(entity, LocalTransform{rest});
    world.registry.add(entity, curve());
    expectNear(dvec3(worldFromEntity(world, entity, 1.0)[3]), {12, 4, 0});
    EXPECT_TRUE(mayMove(world, entity));
    EXPECT_FALSE(mayMove(world, parent));
    world.registry.add(entity, makePath({key(0, {1, 1, 1})}));
    EXPECT_FALSE(mayMove(world, entity)) << "one key";
    expectNear(dvec3(worldFromEntity(world, entity, 7.0)[3]), {12, 2, 2});
    EXPECT_EQ(samplePath(curve(), rest, 0.7).rotation, rest.rotation);
    EXPECT_EQ(samplePath(curve(), rest, 0.7).scale, rest.scale);
}

TEST(Path, BadPathsAreRefusedByKey) {
    EXPECT_TRUE(validatePath(curve()).ok());
    EXPECT_FALSE(validatePath({}).ok()) << "no keys";
    const auto refuse = [](const char* sentence, const auto& change) {
        PathMotion path = curve();
        change(path, path.keys[2]);
        const core::Status valid = validatePath(path);
        ASSERT_FALSE(valid.ok()) << sentence;
        EXPECT_NE(valid.error().message.find(sentence), std::string::npos) << valid.error().message;
    };
    for (const double bad : {1.0, 0.5, kNan})
        refuse("key 2", [&](auto&, auto& key) { key.seconds = bad; });
    refuse("key 2", [](auto&, auto& key) { key.position.y = kNan; });
    refuse("key 2", [](auto&, auto& key) { key.lookAt = dvec3(0.0); });
    refuse("key 2", [](auto&, auto& key) { key.rotation = dquat(1, 0, 0, 0); });
    refuse("key 2", [](auto& path, auto& key) {
        for (PathKey& each : path.keys)
            each.rotation = dquat(1, 0, 0, 0);
        key.rotation = dquat(0, 0, 0, 0);
    });
    refuse("key 2", [](auto& path, auto& key) {
        for (PathKey& each : path.keys)
            each.lookAt = dvec3(9.0);
        key.lookAt->x = kNan;
    });
    refuse("", [](auto& path, auto&) { path.up = dvec3(0.0); });
    refuse("key 0", [](auto& path, auto&) {
        path.keys[0].rotation = dquat(1, 0, 0, 0);
        path.keys[0].lookAt = dvec3(1.0);
    });
}

PathKey lookingKey(double seconds, const dvec3& position, const dvec3& lookAt = dvec3(0.0)) {
    PathKey made = key(seconds, position);
    made.lookAt = lookAt;
    return made;
}

dmat3 axesAt(const PathMotion& path, double seconds) {
    return glm::mat3_cast(samplePath(path, {}, seconds).rotation);
}

double degreesBetween(const dmat3& a, const dmat3& b) {
    const dmat3 turn = glm::transpose(a) * b;
    const double cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1.0) / 2.0;
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// Turns no faster than `degreesPerSecond` anywhere, and faces the origin.
void expectNoLeap(const PathMotion& path, double degreesPerSecond) {
    constexpr double kStep = 1.0 / 1024.0; // falls on keys and on their middles
    dmat3 last = axesAt(path, path.keys.front().seconds);
    for (double t = path.keys.front().seconds + kStep; t <= path.keys.back().seconds; t += kStep) {
        const dmat3 axes = axesAt(path, t);
        ASSERT_LT(degreesBetween(last, axes), degreesPerSecond * kStep) << "at " << t;
        ASSERT_NEAR(glm::determinant(axes), 1.0, 1e-9);
        const dvec3 place = samplePath(path, {}, t).translation;
        expectNear(axes[2], glm::normalize(place));
        last = axes;
    }
}

/// Upright: +X is level, +Y is above.
void expectUpright(const dmat3& axes, const dvec3& up = kUp) {
    EXPECT_NEAR(glm::dot(axes[0], up), 0.0, 1e-9);
    EXPECT_GT(glm::dot(axes[1], up), 0.0);
}

TEST(LookAt, AShotThatBeginsOrEndsStraightDownOrUpDoesNotTurnOver) {
    for (const auto interpolation : kBoth)
        for (const double height : {6.0, -6.0})
            for (const dvec3& away :
                 {dvec3(0, 0, 5), dvec3(0, 0, -5), dvec3(5, 0, 0), dvec3(-3, 0, 2)}) {
                const dvec3 above(0, height, 0);
                const dvec3 aside = dvec3(0, 0.7 * height, 0) + away;
                const auto leaves =
                    makePath({lookingKey(0, above), lookingKey(2, aside)}, interpolation);
                const auto comes =
                    makePath({lookingKey(0, aside), lookingKey(2, above)}, interpolation);
                for (const PathMotion& path : {leaves, comes}) {
                    expectNoLeap(path, 90.0);
                    expectUpright(axesAt(path, 1.0));
                }
                EXPECT_LT(degreesBetween(axesAt(leaves, 0.0), axesAt(comes, 2.0)), 1e-6);
            }
}

TEST(LookAt, StraightDownIsRelativeToUp) {
    PathMotion path =
        makePath({lookingKey(0, {0, 0, 6}), lookingKey(2, {4, 3, 5})}, PathInterpolation::Linear);
    path.up = {0, 0, 2};
    expectNoLeap(path, 90.0);
    expectUpright(axesAt(path, 0.5), kUnitZ);
    path.up = glm::normalize(dvec3(1, 2, 3));
    path.keys[0].position = 6.0 * path.up;
    expectNoLeap(path, 90.0);
    expectUpright(axesAt(path, 0.5), path.up);
}

TEST(LookAt, APathOverItsTargetGoesOnAsItCameAndIsUprightAtTheNextKey) {
    const std::vector<std::vector<PathKey>> flights = {
        {lookingKey(0, {0, 4, 5}),
         lookingKey(2, {0, 6, 0}),
         lookingKey(4, {0, 4, -5})},                            // a key straight above
        {lookingKey(0, {0, 6, 5}), lookingKey(4, {0, 6, -5})},  // between two keys
        {lookingKey(0, {3, 6, 6}), lookingKey(4, {-1, 6, -2})}, // at none of their halves
        {lookingKey(0, {0, 6, 5}),
         lookingKey(2, {0, 6, -5}),
         lookingKey(4, {0, 6, 5})},                              // there and back
        {lookingKey(0, {0, -6, 5}), lookingKey(4, {0, -6, -5})}, // straight up
        {lookingKey(0, {0, 4, 5}),
         lookingKey(2, {0, 6, 0}),
         lookingKey(4, {5, 4, 0})}, // leaves to the side
    };
    for (const auto interpolation : kBoth)
        for (const auto ease : {PathEase::None, PathEase::InOut})
            for (const auto& keys : flights) {
                PathMotion path = makePath(keys, interpolation);
                path.ease = ease;
                expectNoLeap(path, 400.0);
                for (const PathKey& each : path.keys)
                    if (each.position.x != 0.0 || each.position.z != 0.0)
                        expectUpright(axesAt(path, each.seconds));
            }
    const PathMotion beside = makePath({lookingKey(0, {0.01, 6, 5}), lookingKey(2, {0.01, 6, -5})});
    for (double t = 0.0; t <= 2.0; t += 1.0 / 64.0)
        expectUpright(axesAt(beside, t));
}

/// When the path is straight above the origin, between two times.
double findCrossing(const PathMotion& path, double low, double high) {
    const auto zAt = [&](double t) { return samplePath(path, {}, t).translation.z; };
    const double side = zAt(low);
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (zAt(middle) * side > 0.0 ? low : high) = middle;
    }
    return high;
}

TEST(LookAt, TheViewIsContinuousAtStraightDown) {
    // It crosses over at about 1.1 s, and back at about 1.9 s.
    const PathMotion twice = makePath(
        {lookingKey(0, {0, 4, 16}),
         lookingKey(1, {0, 6, 0.5}),
         lookingKey(2, {0, 5, 0.5}),
         lookingKey(3, {0, 4, 16})}
    );
    expectUpright(axesAt(twice, 1.0));
    expectUpright(axesAt(twice, 2.0));
    for (const double crossing : {findCrossing(twice, 1.0, 1.5), findCrossing(twice, 1.5, 2.0)}) {
        const dmat3 before = axesAt(twice, crossing - 1e-4);
        for (const double away : {-1e-6, -1e-9, -1e-14, 0.0, 1e-14, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4})
            EXPECT_LT(degreesBetween(axesAt(twice, crossing + away), before), 2.0) << away;
    }
}

TEST(LookAt, AWayThatStaysStraightAboveKeepsItsTurn) {
    // Onto the target, a hold, down to it, sideways with it, and away.
    const PathMotion path = makePath(
        {lookingKey(0, {0, 6, 3}),
         lookingKey(1, {0, 6, 0}),
         lookingKey(2, {0, 6, 0}),
         lookingKey(3, {0, 4, 0}),
         lookingKey(4, {2, 4, 1}, {2, 0, 1}),
         lookingKey(5, {2, 4, -4}, {2, 0, 1})},
        PathInterpolation::Linear
    );
    const dmat3 down = axesAt(path, 1.0);
    for (const double t : {1.25, 2.0, 2.5, 3.0, 3.5, 4.0})
        EXPECT_LT(degreesBetween(axesAt(path, t), down), 1e-6) << t;
    constexpr double kStep = 1.0 / 256.0;
    for (double t = 0.0; t < 5.0; t += kStep)
        ASSERT_LT(degreesBetween(axesAt(path, t), axesAt(path, t + kStep)), 400.0 * kStep) << t;
    expectUpright(axesAt(path, 5.0));
    const PathMotion always = makePath(
        {lookingKey(0, {0, 6, 0}),
         lookingKey(1, {1, 5, 0}, {1, 0, 0}),
         lookingKey(2, {1, 4, 3}, {1, 0, 3})},
        PathInterpolation::Linear
    );
    for (const double t : {0.5, 1.0, 1.75, 2.0})
        EXPECT_LT(degreesBetween(axesAt(always, t), axesAt(always, 0.0)), 1e-6) << t;
}

TEST(LookAt, EachShotHasAStraightDownOfItsOwn) {
    PathMotion path = makePath(
        {lookingKey(0, {0, 4, 5}),
         lookingKey(1, {0, 6, 0}),
         lookingKey(2, {0, 6, 0}),
         lookingKey(3, {5, 4, 0})}
    );
    path.keys[2].cut = true;
    // It comes from +Z, whose view has -Z above; the next shot leaves to +X.
    expectNear(axesAt(path, 1.5)[1], {0, 0, -1});
    expectNear(axesAt(path, 2.0)[1], {-1, 0, 0});
}

TEST(LookAt, ATargetAtTheCameraUsesTheDirectionOfTravel) {
    for (const auto interpolation : kBoth) {
        const PathMotion comes = makePath(
            {lookingKey(0, {3, 1, 4}), lookingKey(1, dvec3(0.0)), lookingKey(2, dvec3(0.0))},
            interpolation
        );
        for (const double t : {0.5, 1.0, 1.5, 2.0, 3.0})
            expectNear(axesAt(comes, t)[2], glm::normalize(dvec3(3, 1, 4)), 1e-6);
        const PathMotion goes =
            makePath({lookingKey(0, dvec3(0.0)), lookingKey(1, {3, 1, 4})}, interpolation);
        for (const double t : {-1.0, 0.0, 0.5, 1.0}) {
            expectNear(axesAt(goes, t)[2], glm::normalize(dvec3(3, 1, 4)), 1e-6);
            expectUpright(axesAt(goes, t));
        }
        // Through it: behind it, the view faces back, upright.
        const PathMotion through =
            makePath({lookingKey(0, {3, 1, 4}), lookingKey(1, {-3, -1, -4})}, interpolation);
        for (const double t : {0.25, 0.5, 0.75, 1.0})
            expectUpright(axesAt(through, t));
        expectNear(axesAt(through, 0.5)[2], glm::normalize(dvec3(3, 1, 4)), 1e-6);
    }
    PathMotion nowhere = makePath({lookingKey(0, {1, 2, 3}, {1, 2, 3})}, PathInterpolation::Linear);
    EXPECT_EQ(samplePath(nowhere, {}, 0.0).rotation, math::dquat(1, 0, 0, 0));
}

} // namespace
} // namespace shutter::scene
