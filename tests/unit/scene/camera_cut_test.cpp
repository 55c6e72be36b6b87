// SPDX-License-Identifier: MIT
#include "engine/math/transform.h"
#include "engine/scene/camera.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace shutter::scene {
namespace {

using math::dmat4;
using math::dvec3;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr CutDetection kDetection{true, 10.0, 0.5};

dmat4 pose(double degrees, const dvec3& position) {
    math::Transform transform;
    transform.translation = position;
    transform.rotation = glm::angleAxis(degrees * kDegree, dvec3(0.0, 1.0, 0.0));
    return math::computeMatrix(transform);
}

bool finds(const PoseAt& poseAt) {
    return findsCameraCut(poseAt, 100.0, 100.02, kDetection);
}

TEST(CameraCut, ASmoothPanIsNoneHoweverFast) {
    // 180, 2000 and 100000 degrees a second.
    for (const double speed : {180.0, 2000.0, 1e5})
        EXPECT_FALSE(finds([&](double t) { return pose(speed * (t - 100.0), dvec3(0.0)); }));
}

TEST(CameraCut, ARaceIsNoneHoweverFast) {
    for (const double speed : {30.0, 1e3, 1e7})
        EXPECT_FALSE(finds([&](double t) { return pose(0.0, {speed * (t - 100.0), 0, 0}); }));
}

TEST(CameraCut, AJumpIsOneWhereverItLies) {
    for (const double at : {100.0000001, 100.0007, 100.01, 100.01999}) {
        EXPECT_TRUE(finds([&](double t) { return pose(t < at ? 0.0 : 15.0, dvec3(0.0)); })) << at;
        EXPECT_TRUE(finds([&](double t) { return pose(0.0, dvec3(t < at ? 0.0 : 0.7)); })) << at;
    }
}

TEST(CameraCut, AJumpWithinAFastPanIsOne) {
    EXPECT_TRUE(finds([&](double t) {
        return pose(4000.0 * (t - 100.0) + (t < 100.0123 ? 0.0 : 25.0), {300.0 * t, 0, 0});
    }));
}

TEST(CameraCut, AJumpBelowTheThresholdsIsNone) {
    EXPECT_FALSE(finds([&](double t) { return pose(t < 100.01 ? 0.0 : 9.0, dvec3(0.0)); }));
    EXPECT_FALSE(finds([&](double t) { return pose(0.0, {t < 100.01 ? 0.0 : 0.45, 0, 0}); }));
}

TEST(CameraCut, ThereAndBackWithinASixteenthIsSeenAtItsStepsOnly) {
    // Three whole intervals elsewhere: two jumps, each found by itself.
    EXPECT_TRUE(finds([&](double t) {
        return pose(t > 100.005 && t < 100.009 ? 90.0 : 0.0, dvec3(0.0));
    }));
}

TEST(CameraCut, NothingIsFoundWhereDetectionIsOffOrThereIsNoTime) {
    const auto jumps = [](double t) { return pose(t < 100.01 ? 0.0 : 90.0, dvec3(0.0)); };
    EXPECT_FALSE(findsCameraCut(jumps, 100.0, 100.02, {false, 10.0, 0.5}));
    EXPECT_FALSE(findsCameraCut(jumps, 100.01, 100.01, kDetection));
    EXPECT_FALSE(findsCameraCut(jumps, 100.02, 100.0, kDetection));
}

TEST(CameraCut, ACameraThatIsNowhereForAWhileIsNotCut) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(finds([&](double t) {
        return math::removeScale(pose(t < 100.01 ? 0.0 : nan, dvec3(t < 100.01 ? 0.0 : nan)));
    }));
}

TEST(CameraCut, AJumpFarFromTimeZeroIsOne) {
    // Where two neighbouring times are 1e-7 s apart, the halving ends early.
    EXPECT_TRUE(findsCameraCut(
        [](double t) { return pose(t < 1e9 + 0.5 ? 0.0 : 90.0, dvec3(0.0)); },
        1e9,
        1e9 + 1,
        kDetection
    ));
}

} // namespace
} // namespace shutter::scene
