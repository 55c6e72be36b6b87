// SPDX-License-Identifier: MIT
// Paths that look straight down or up, or at where they are.
#include "engine/scene/path.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace shutter::scene {
namespace {

using math::dmat3;
using math::dvec3;

PathKey key(double seconds, const dvec3& position, const dvec3& lookAt = dvec3(0.0)) {
    PathKey made;
    made.seconds = seconds;
    made.position = position;
    made.lookAt = lookAt;
    return made;
}

PathMotion makePath(std::vector<PathKey> keys, PathInterpolation interpolation) {
    PathMotion path;
    path.keys = std::move(keys);
    path.interpolation = interpolation;
    return path;
}

dmat3 axesAt(const PathMotion& path, double seconds) {
    return glm::mat3_cast(samplePath(path, {}, seconds).rotation);
}

double degreesBetween(const dmat3& a, const dmat3& b) {
    const dmat3 turn = glm::transpose(a) * b;
    const double cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1.0) / 2.0;
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// Turns no faster than `degreesPerSecond` anywhere, and looks at the origin.
void expectSmooth(const PathMotion& path, double degreesPerSecond) {
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

constexpr PathInterpolation kBoth[] = {PathInterpolation::Linear, PathInterpolation::CatmullRom};

TEST(LookAt, AShotThatBeginsOrEndsStraightDownOrUpDoesNotTurnOver) {
    for (const auto interpolation : kBoth)
        for (const double height : {6.0, -6.0})
            for (const dvec3& away :
                 {dvec3(0, 0, 5), dvec3(0, 0, -5), dvec3(5, 0, 0), dvec3(-3, 0, 2)}) {
                const dvec3 above(0, height, 0);
                const dvec3 aside = dvec3(0, 0.7 * height, 0) + away;
                const auto leaves = makePath({key(0, above), key(2, aside)}, interpolation);
                expectSmooth(leaves, 90.0);
                expectUpright(axesAt(leaves, 1.0));
                const auto comes = makePath({key(0, aside), key(2, above)}, interpolation);
                expectSmooth(comes, 90.0);
                expectUpright(axesAt(comes, 1.0));
                EXPECT_LT(degreesBetween(axesAt(leaves, 0.0), axesAt(comes, 2.0)), 1e-6);
            }
}

TEST(LookAt, AnotherUpHasItsOwnStraightDown) {
    PathMotion path = makePath({key(0, {0, 0, 6}), key(2, {4, 3, 5})}, PathInterpolation::Linear);
    path.up = {0, 0, 2};
    expectSmooth(path, 90.0);
    expectUpright(axesAt(path, 0.5), kUnitZ);
    path.up = glm::normalize(dvec3(1, 2, 3));
    path.keys[0].position = 6.0 * path.up;
    expectSmooth(path, 90.0);
    expectUpright(axesAt(path, 0.5), path.up);
}

TEST(LookAt, APathOverItsTargetGoesOnAsItCameAndIsUprightAtTheNextKey) {
    const std::vector<std::vector<PathKey>> flights = {
        {key(0, {0, 4, 5}), key(2, {0, 6, 0}), key(4, {0, 4, -5})}, // a key straight above
        {key(0, {0, 6, 5}), key(4, {0, 6, -5})},                    // between two keys
        {key(0, {3, 6, 6}), key(4, {-1, 6, -2})},                   // at none of their halves
        {key(0, {0, 6, 5}), key(2, {0, 6, -5}), key(4, {0, 6, 5})}, // there and back
        {key(0, {0, -6, 5}), key(4, {0, -6, -5})},                  // straight up
        {key(0, {0, 4, 5}), key(2, {0, 6, 0}), key(4, {5, 4, 0})},  // leaves to the side
    };
    for (const auto interpolation : kBoth)
        for (const auto ease : {PathEase::None, PathEase::InOut})
            for (const auto& keys : flights) {
                PathMotion path = makePath(keys, interpolation);
                path.ease = ease;
                expectSmooth(path, 400.0);
                for (const PathKey& each : path.keys)
                    if (each.position.x != 0.0 || each.position.z != 0.0)
                        expectUpright(axesAt(path, each.seconds));
            }
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

TEST(LookAt, OnStraightDownAndCloseToItTheViewIsAsJustBeforeIt) {
    // It crosses over at about 1.1 s, and back at about 1.9 s.
    const PathMotion twice = makePath(
        {key(0, {0, 4, 16}), key(1, {0, 6, 0.5}), key(2, {0, 5, 0.5}), key(3, {0, 4, 16})},
        PathInterpolation::CatmullRom
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
        {key(0, {0, 6, 3}),
         key(1, {0, 6, 0}),
         key(2, {0, 6, 0}),
         key(3, {0, 4, 0}),
         key(4, {2, 4, 1}, {2, 0, 1}),
         key(5, {2, 4, -4}, {2, 0, 1})},
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
        {key(0, {0, 6, 0}), key(1, {1, 5, 0}, {1, 0, 0}), key(2, {1, 4, 3}, {1, 0, 3})},
        PathInterpolation::Linear
    );
    for (const double t : {0.5, 1.0, 1.75, 2.0})
        EXPECT_LT(degreesBetween(axesAt(always, t), axesAt(always, 0.0)), 1e-6) << t;
}

TEST(LookAt, EachShotHasAStraightDownOfItsOwn) {
    PathMotion path = makePath(
        {key(0, {0, 4, 5}), key(1, {0, 6, 0}), key(2, {0, 6, 0}), key(3, {5, 4, 0})},
        PathInterpolation::CatmullRom
    );
    path.keys[2].cut = true;
    // It comes from +Z, whose view has -Z above; the next shot leaves to +X.
    expectNear(axesAt(path, 1.5)[1], {0, 0, -1});
    expectNear(axesAt(path, 2.0)[1], {-1, 0, 0});
}

TEST(LookAt, AtItsOwnPlaceItLooksTheWayThatItComesOrGoes) {
    for (const auto interpolation : kBoth) {
        const PathMotion comes =
            makePath({key(0, {3, 1, 4}), key(1, dvec3(0.0)), key(2, dvec3(0.0))}, interpolation);
        for (const double t : {0.5, 1.0, 1.5, 2.0, 3.0})
            expectNear(axesAt(comes, t)[2], glm::normalize(dvec3(3, 1, 4)), 1e-6);
        const PathMotion goes = makePath({key(0, dvec3(0.0)), key(1, {3, 1, 4})}, interpolation);
        for (const double t : {-1.0, 0.0, 0.5, 1.0}) {
            expectNear(axesAt(goes, t)[2], glm::normalize(dvec3(3, 1, 4)), 1e-6);
            expectUpright(axesAt(goes, t));
        }
        // Through it: behind it, it looks back, upright.
        const PathMotion through =
            makePath({key(0, {3, 1, 4}), key(1, {-3, -1, -4})}, interpolation);
        for (const double t : {0.25, 0.5, 0.75, 1.0})
            expectUpright(axesAt(through, t));
        expectNear(axesAt(through, 0.5)[2], glm::normalize(dvec3(3, 1, 4)), 1e-6);
    }
    PathMotion nowhere = makePath({key(0, {1, 2, 3}, {1, 2, 3})}, PathInterpolation::Linear);
    EXPECT_EQ(samplePath(nowhere, {}, 0.0).rotation, math::dquat(1, 0, 0, 0));
}

TEST(LookAt, APathThatPassesBesideStraightDownIsUprightThroughout) {
    const PathMotion path =
        makePath({key(0, {0.01, 6, 5}), key(2, {0.01, 6, -5})}, PathInterpolation::CatmullRom);
    for (double t = 0.0; t <= 2.0; t += 1.0 / 64.0)
        expectUpright(axesAt(path, t));
}

} // namespace
} // namespace shutter::scene
