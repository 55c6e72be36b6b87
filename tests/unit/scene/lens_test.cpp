// SPDX-License-Identifier: MIT
#include "engine/scene/camera.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace shutter::scene {
namespace {

double focal(double yFov) {
    return 1.0 / std::tan(yFov / 2.0);
}

class Lens : public testing::Test {
  protected:
    Lens() : mCamera(mWorld.registry.create()) {
        mWorld.registry.add(mCamera, Camera{.yFov = 0.7});
    }

    void zoom(
        std::vector<LensKey> keys,
        PathInterpolation interpolation = PathInterpolation::CatmullRom,
        PathEase ease = PathEase::None
    ) {
        const LensMotion lens{std::move(keys), interpolation, ease};
        ASSERT_TRUE(validateLens(lens).ok());
        mWorld.registry.add(mCamera, lens);
    }

    [[nodiscard]] double at(double seconds) const { return yFovAt(mWorld, mCamera, seconds); }

    World mWorld;
    ecs::Entity mCamera;
};

TEST_F(Lens, WithoutKeysItIsTheCamerasOwnAtEveryTime) {
    EXPECT_EQ(at(-5.0), 0.7);
    EXPECT_EQ(at(5.0), 0.7);
    EXPECT_FALSE(mayZoom(mWorld, mCamera));
}

TEST_F(Lens, GoesThroughItsKeysAndStaysAtTheEnds) {
    for (const auto interpolation : {PathInterpolation::Linear, PathInterpolation::CatmullRom}) {
        zoom({{0.0, 0.9}, {1.0, 0.4}, {3.0, 1.2}}, interpolation);
        EXPECT_TRUE(mayZoom(mWorld, mCamera));
        EXPECT_EQ(at(-1.0), 0.9);
        EXPECT_EQ(at(0.0), 0.9);
        EXPECT_NEAR(at(1.0), 0.4, 1e-15);
        EXPECT_EQ(at(3.0), 1.2);
        EXPECT_EQ(at(9.0), 1.2);
    }
}

TEST_F(Lens, TwoEqualKeysHoldStillToTheBit) {
    for (const auto interpolation : {PathInterpolation::Linear, PathInterpolation::CatmullRom}) {
        zoom({{0.0, 0.9}, {1.0, 0.4}, {3.0, 0.4}, {4.0, 1.2}}, interpolation);
        for (double t = 1.0; t <= 3.0; t += 0.125)
            EXPECT_EQ(at(t), at(1.0)) << t;
        EXPECT_NE(at(0.9), at(1.0));
    }
}

TEST_F(Lens, AStraightZoomMultipliesTheFocalLengthEvenly) {
    zoom({{0.0, 1.0}, {2.0, 0.3}}, PathInterpolation::Linear);
    const double ratio = focal(at(0.5)) / focal(at(0.0));
    EXPECT_GT(ratio, 1.0);
    for (const double t : {0.5, 1.0, 1.5})
        EXPECT_NEAR(focal(at(t + 0.5)) / focal(at(t)), ratio, 1e-12) << t;
}

TEST_F(Lens, EasesAsAPathDoes) {
    zoom({{0.0, 1.0}, {2.0, 0.3}}, PathInterpolation::Linear, PathEase::InOut);
    const double whole = std::log(focal(0.3) / focal(1.0));
    EXPECT_NEAR(std::log(focal(at(0.5)) / focal(1.0)) / whole, 0.15625, 1e-12);
}

TEST_F(Lens, StaysALensBetweenTheWidestKeys) {
    zoom({{0.0, 3.14}, {0.01, 1e-9}, {1.0, 1e-9}, {1.01, 3.14}, {5.0, 1e-3}});
    for (double t = -0.1; t < 5.2; t += 0.003) {
        ASSERT_GT(at(t), 0.0) << t;
        ASSERT_LT(at(t), std::numbers::pi) << t;
    }
}

TEST_F(Lens, RestsToTheLastBitBetweenEqualKeys) {
    zoom({{0.0, 0.123}, {1.0, 0.123}, {2.0, 0.123}});
    EXPECT_FALSE(mayZoom(mWorld, mCamera));
    for (double t = -0.5; t < 2.5; t += 0.0173)
        ASSERT_EQ(at(t), 0.123);
}

TEST_F(Lens, ACutJumps) {
    zoom({{0.0, 0.9}, {1.0, 0.8}, {2.0, 0.3, true}, {3.0, 0.2}});
    EXPECT_EQ(at(1.999), 0.8);
    EXPECT_EQ(at(2.0), 0.3);
    const auto& lens = mWorld.registry.get<LensMotion>(mCamera);
    EXPECT_TRUE(hasCutWithin(lens, 1.9, 2.0));
    EXPECT_FALSE(hasCutWithin(lens, 2.0, 2.1));
    // Within a frame in which the lens, or the path alone, jumps, nothing zooms.
    const ExposureMotion cut(mWorld, mCamera, computeExposure({0.1}, 2.01));
    EXPECT_TRUE(cut.isCut());
    EXPECT_EQ(cut.cameraYFov(0.0), at(2.01));
    EXPECT_EQ(cut.cameraYFov(1.0), at(2.01));
    EXPECT_FALSE(cut.mayCameraZoom());
}

TEST_F(Lens, ACutOfThePathHoldsTheLensInThatFrame) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    PathMotion path;
    path.keys.resize(2);
    path.keys[1].seconds = 2.0;
    path.keys[1].cut = true;
    mWorld.registry.add(mCamera, path);
    const ExposureMotion cut(mWorld, mCamera, computeExposure({0.1}, 2.01));
    EXPECT_EQ(cut.cameraYFov(0.0), at(2.01));
    const ExposureMotion before(mWorld, mCamera, computeExposure({0.1}, 1.9));
    EXPECT_EQ(before.cameraYFov(0.0), at(before.exposure().open));
    EXPECT_NE(before.cameraYFov(0.0), before.cameraYFov(1.0));
    EXPECT_TRUE(before.mayCameraZoom());
}

TEST_F(Lens, BlurByZoomingScalesWithThatByTurning) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    CameraShutter shutter{.exposureSeconds = 0.5};
    const auto lensAt = [&](double s) {
        return ExposureMotion(mWorld, mCamera, computeExposure(shutter, 2.0)).cameraYFov(s);
    };
    EXPECT_EQ(lensAt(0.0), at(1.5));
    shutter.cameraRotationScale = 0.5;
    EXPECT_EQ(lensAt(0.0), at(1.75));
    shutter.cameraRotationScale = 0.0;
    EXPECT_EQ(lensAt(0.0), at(2.0));
}

TEST_F(Lens, WhatIsExcludedFromBlurIsZoomedAlong) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    const ecs::Entity still = mWorld.registry.create();
    mWorld.registry.add(still, LocalTransform{{{1.0, 2.0, -5.0}, {1, 0, 0, 0}, math::dvec3(1.0)}});
    mWorld.registry.add(still, MotionBlur{.exclude = true});
    const ExposureMotion motion(mWorld, mCamera, computeExposure({0.5}, 2.0));
    EXPECT_TRUE(motion.mayObjectMove(still));
    const auto seen = [&](double s) {
        const math::dvec4 place = motion.worldFromObject(still, s)[3];
        return math::dvec2(place) / -place.z * focal(motion.cameraYFov(s));
    };
    EXPECT_NE(motion.worldFromObject(still, 0.0), motion.worldFromObject(still, 1.0));
    for (const double s : {0.0, 0.3, 0.7}) {
        EXPECT_NEAR(seen(s).x, seen(1.0).x, 1e-12);
        EXPECT_NEAR(seen(s).y, seen(1.0).y, 1e-12);
    }
}

TEST_F(Lens, AnOrthographicCameraHasNone) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    mWorld.registry.get<Camera>(mCamera).kind = CameraKind::Orthographic;
    EXPECT_FALSE(mayZoom(mWorld, mCamera));
    EXPECT_EQ(at(2.0), 0.7);
}

TEST(LensKeys, WrongOnesAreNamed) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const auto errorOf = [](std::vector<LensKey> keys) {
        const core::Status valid = validateLens({std::move(keys)});
        return valid.ok() ? std::string() : valid.error().message;
    };
    EXPECT_EQ(errorOf({{0.0, 0.5}}), "");
    EXPECT_NE(errorOf({}).find("no keys"), std::string::npos);
    EXPECT_NE(errorOf({{kNan, 0.5}}).find("time of key 0"), std::string::npos);
    EXPECT_NE(errorOf({{1.0, 0.5}, {1.0, 0.6}}).find("key 1 at 1 s"), std::string::npos);
    for (const double wrong : {0.0, -1.0, std::numbers::pi, kNan})
        EXPECT_NE(errorOf({{1.0, wrong}}).find("field of view of key 0"), std::string::npos);
}

} // namespace
} // namespace shutter::scene
