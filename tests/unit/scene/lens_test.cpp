// SPDX-License-Identifier: MIT
// The lens: the shape of its opening, its effect on points, its focus, its zoom, and refusals.
#include "engine/scene/camera.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace shutter::scene {
namespace {

using math::dvec2;
using shader::Aperture;

constexpr double kPi = std::numbers::pi;

/// How far the opening reaches in a direction.
double findReach(const Aperture& aperture, double angle) {
    constexpr int kSteps = 512;
    double reach = 0.0;
    for (int i = 0; i < kSteps; ++i)
        for (int edge = 0; edge < 4; ++edge) { // of the square, which becomes the opening's
            const float along = float(i) / kSteps;
            const float side = edge % 2 == 0 ? 0.0f : 1.0f;
            const math::vec2 place = edge < 2 ? math::vec2(along, side) : math::vec2(side, along);
            const dvec2 point(shader::aperturePoint(aperture, place));
            reach = std::max(reach, glm::dot(point, dvec2(std::cos(angle), std::sin(angle))));
        }
    return reach;
}

TEST(Aperture, APolygonHasItsCornersAndSides) {
    for (const uint32_t blades : {3u, 5u, 6u, 16u})
        for (const double rotation : {0.0, 0.3, -2.0})
            for (uint32_t i = 0; i < blades; ++i) {
                const Aperture aperture{blades, float(rotation), 0.0f, 1.0f};
                const double corner = rotation + 2.0 * kPi * i / blades;
                const double side = corner + kPi / blades;
                EXPECT_NEAR(findReach(aperture, corner), 1.0, 1e-3) << blades;
                EXPECT_NEAR(findReach(aperture, side), std::cos(kPi / blades), 1e-3) << blades;
            }
}

TEST(Aperture, SqueezeIsWidthByHeight) {
    for (const float squeeze : {0.5f, 1.0f, 2.0f}) {
        const Aperture aperture{0, 0.0f, 0.0f, squeeze};
        EXPECT_NEAR(findReach(aperture, 0.0), squeeze, 1e-3);
        EXPECT_NEAR(findReach(aperture, kPi), squeeze, 1e-3);
        EXPECT_NEAR(findReach(aperture, kPi / 2.0), 1.0, 1e-3);
    }
}

TEST(Aperture, EqualAreasOfTheSquareAreEqualAreasOfTheOpening) {
    constexpr int kCells = 32;
    for (const Aperture& aperture :
         {Aperture{0, 0.0f, 0.0f, 1.0f},
          Aperture{0, 0.0f, 0.0f, 2.0f},
          Aperture{3, 0.0f, 0.0f, 1.0f},
          Aperture{6, 0.4f, 0.0f, 0.5f},
          Aperture{5, 0.0f, 0.5f, 1.0f},
          Aperture{5, 0.0f, 1.0f, 1.0f}}) {
        const double sector = 2.0 * kPi / std::max(aperture.blades, 1u);
        const double polygon =
            aperture.blades == 0 ? kPi : 0.5 * aperture.blades * std::sin(sector);
        const double area = aperture.squeeze * std::lerp(polygon, kPi, double(aperture.roundness));
        double sum = 0.0;
        for (int y = 0; y < kCells; ++y)
            for (int x = 0; x < kCells; ++x) {
                const auto at = [&](int i, int j) {
                    const math::vec2 place(float(x + i) / kCells, float(y + j) / kCells);
                    return dvec2(shader::aperturePoint(aperture, place));
                };
                const dvec2 across = at(1, 1) - at(0, 0);
                const dvec2 back = at(0, 1) - at(1, 0);
                const double cell = 0.5 * (across.x * back.y - across.y * back.x);
                sum += cell;
                // Cells that hold a fold of the map are no parallelograms.
                EXPECT_NEAR(cell * kCells * kCells / area, 1.0, 0.15) << x << " " << y;
            }
        EXPECT_NEAR(sum / area, 1.0, 0.01) << aperture.blades << " " << aperture.roundness;
    }
}

TEST(ThinLens, TheCircleOfConfusionIsTheThinLenss) {
    CameraLens lens{.fStop = 2.0, .focusDistance = 4.0};
    const double yFov = 2.0 * std::atan(0.5); // f is the sensor's height
    const double radius = computeLensRadius(lens, yFov);
    EXPECT_NEAR(radius, 0.006, 1e-12);
    EXPECT_EQ(computeConfusionDiameter(lens, radius, 4.0, 500.0), 0.0);
    EXPECT_NEAR(computeConfusionDiameter(lens, radius, 2.0, 500.0), 1.5, 1e-12);
    EXPECT_NEAR(computeConfusionDiameter(lens, radius, kInfinity, 500.0), 1.5, 1e-12);
    lens.fStop *= 2.0;
    EXPECT_NEAR(computeLensRadius(lens, yFov), radius / 2.0, 1e-12);
    lens.blurScale = 2.0;
    EXPECT_NEAR(computeLensRadius(lens, yFov), radius, 1e-12);
    for (CameraLens none : {CameraLens{.fStop = 0.0}, CameraLens{.fStop = 1.0, .blurScale = 0.0}})
        EXPECT_EQ(computeLensRadius(none, yFov), 0.0);
}

TEST(ThinLens, EachFieldIsGuarded) {
    const std::vector<std::pair<const char*, std::function<void(CameraLens&, double)>>> fields = {
        {"fStop", [](CameraLens& lens, double x) { lens.fStop = x; }},
        {"focusDistance", [](CameraLens& lens, double x) { lens.focusDistance = x; }},
        {"sensorHeight", [](CameraLens& lens, double x) { lens.sensorHeight = x; }},
        {"bladeRotation", [](CameraLens& lens, double x) { lens.bladeRotation = x; }},
        {"roundness", [](CameraLens& lens, double x) { lens.roundness = x; }},
        {"squeeze", [](CameraLens& lens, double x) { lens.squeeze = x; }},
        {"blurScale", [](CameraLens& lens, double x) { lens.blurScale = x; }}};
    const auto refuses = [&](const char* field, const CameraLens& lens) {
        const core::Status valid = validate(lens, "lens.");
        ASSERT_FALSE(valid.ok()) << field;
        EXPECT_TRUE(valid.error().message.starts_with(std::string("lens.") + field))
            << valid.error().message;
    };
    EXPECT_TRUE(validate(CameraLens{}).ok());
    for (const auto& [field, set] : fields)
        for (const double bad : {kNan, kInfinity, -kInfinity, -10.0, 2.0e9}) {
            CameraLens lens;
            set(lens, bad);
            refuses(field, lens);
        }
    refuses("fStop", {.fStop = 1.0e-3});
    refuses("focusDistance", {.focusDistance = 0.0});
    refuses("sensorHeight", {.sensorHeight = 0.0});
    refuses("squeeze", {.squeeze = 0.0});
    for (const uint32_t blades : {1u, 2u, 17u})
        refuses("blades", {.blades = blades});
}

class Lens : public testing::Test {
  protected:
    Lens() : mCamera(mWorld.registry.create()) {
        mWorld.registry.add(mCamera, Camera{.yFov = 0.7});
        mWorld.registry.add(mCamera, CameraLens{.fStop = 2.0, .focusDistance = 7.0});
    }

    void pull(std::vector<FocusKey> keys, PathInterpolation interpolation) {
        const FocusMotion motion{std::move(keys), interpolation, PathEase::None};
        ASSERT_TRUE(validateFocus(motion).ok());
        mWorld.registry.add(mCamera, motion);
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

    [[nodiscard]] CameraLens at(double seconds) const { return lensAt(mWorld, mCamera, seconds); }

    [[nodiscard]] double viewAt(double seconds) const { return yFovAt(mWorld, mCamera, seconds); }

    [[nodiscard]] ExposureMotion expose(double exposureSeconds, double raster) const {
        return {mWorld, mCamera, computeExposure({exposureSeconds}, raster)};
    }

    World mWorld;
    ecs::Entity mCamera;
};

TEST_F(Lens, DistancesAreInterpolatedAsInversesAndFNumbersAsLogarithms) {
    pull({{0.0, 1.0, 2.0, false}, {1.0, 3.0, 8.0, false}}, PathInterpolation::Linear);
    EXPECT_NEAR(at(0.5).focusDistance, 1.5, 1e-12);
    EXPECT_NEAR(at(0.5).fStop, 4.0, 1e-12);
    for (const double seconds : {-5.0, 0.0}) {
        EXPECT_EQ(at(seconds).focusDistance, 1.0);
        EXPECT_EQ(at(seconds).fStop, 2.0);
    }
    EXPECT_NEAR(at(9.0).focusDistance, 3.0, 1e-12);
    pull({{0.0, 1.0, {}, false}}, PathInterpolation::Linear);
    EXPECT_EQ(at(0.0).fStop, 2.0) << "what keys lack is the lens's";
    EXPECT_EQ(at(0.0).focusDistance, 1.0);
    mWorld.registry.get<Camera>(mCamera).kind = CameraKind::Orthographic;
    EXPECT_EQ(at(0.0).fStop, 0.0) << "it has no focal length";
}

TEST_F(Lens, TheFocusJumpsAtACutAndStaysThisSideOfInfinity) {
    pull(
        {{0.0, 1.0, {}, false}, {1.0, 3.0, {}, true}, {2.0, 3.0, {}, false}},
        PathInterpolation::CatmullRom
    );
    EXPECT_EQ(at(0.999).focusDistance, 1.0);
    EXPECT_EQ(at(1.0).focusDistance, 3.0);
    pull(
        {{0.0, 0.1, {}, false}, {1.0, 1.0e9, {}, false}, {2.0, 9.0e8, {}, false}},
        PathInterpolation::CatmullRom
    );
    for (double seconds = 0.0; seconds <= 2.0; seconds += 0.01) {
        ASSERT_GE(at(seconds).focusDistance, 0.05) << seconds;
        ASSERT_LE(at(seconds).focusDistance, 1.1e9) << seconds;
    }
}

TEST_F(Lens, AViewerReplacesWhatHeNamesAndScalesTheRest) {
    pull({{0.0, 1.0, 4.0, false}, {1.0, 3.0, 4.0, false}}, PathInterpolation::Linear);
    mWorld.registry.add(mCamera, LensOverride{});
    EXPECT_EQ(at(0.0).focusDistance, 1.0);
    EXPECT_EQ(at(0.0).fStop, 4.0);
    mWorld.registry.add(mCamera, LensOverride{.fStop = 8.0, .blurScale = 0.5});
    EXPECT_EQ(at(0.0).focusDistance, 1.0);
    EXPECT_EQ(at(0.0).fStop, 8.0);
    EXPECT_EQ(at(0.0).blurScale, 0.5);
    mWorld.registry.add(mCamera, LensOverride{.focusDistance = 9.0});
    EXPECT_EQ(at(0.0).focusDistance, 9.0);
    EXPECT_TRUE(hasLens(mWorld, mCamera));
    mWorld.registry.add(mCamera, LensOverride{.fStop = 8.0, .blurScale = 0.0});
    EXPECT_FALSE(hasLens(mWorld, mCamera));
    EXPECT_EQ(computeLensRadius(at(0.0), 0.8), 0.0);
    mWorld.registry.remove<FocusMotion>(mCamera);
    mWorld.registry.remove<CameraLens>(mCamera);
    EXPECT_FALSE(hasLens(mWorld, mCamera));
    mWorld.registry.add(mCamera, LensOverride{.fStop = 8.0});
    EXPECT_TRUE(hasLens(mWorld, mCamera)) << "he opens a pinhole";
    mWorld.registry.get<Camera>(mCamera).kind = CameraKind::Orthographic;
    EXPECT_FALSE(hasLens(mWorld, mCamera));
    for (const LensOverride& bad :
         {LensOverride{.fStop = 0.001},
          LensOverride{.fStop = kNan},
          LensOverride{.focusDistance = 1.0e-5},
          LensOverride{.focusDistance = kInfinity},
          LensOverride{.blurScale = 2.5}})
        EXPECT_FALSE(validate(bad).ok());
}

TEST(LensKeys, BadKeysOfZoomAndFocusAreRefusedByName) {
    const auto expectRefused = [](const core::Status& valid, const char* sentence) {
        ASSERT_FALSE(valid.ok()) << sentence;
        EXPECT_NE(valid.error().message.find(sentence), std::string::npos) << valid.error().message;
    };
    EXPECT_TRUE(validateLens({{{0.0, 0.5}}}).ok());
    expectRefused(validateLens({}), "no keys");
    expectRefused(validateLens({{{kNan, 0.5}}}), "time of key 0");
    expectRefused(validateLens({{{1.0, 0.5}, {1.0, 0.6}}}), "key 1 at 1 s");
    for (const double bad : {0.0, -1.0, kPi, kNan})
        expectRefused(validateLens({{{1.0, bad}}}), "field of view of key 0");
    const FocusKey good{1.0, 1.0, {}, false};
    expectRefused(validateFocus({}), "no keys");
    expectRefused(validateFocus({{{kNan, 1.0, {}, false}}}), "time of key 0");
    expectRefused(validateFocus({{good, good}}), "key 1 at 1 s");
    expectRefused(validateFocus({{good, {2.0, {}, 1.0, false}}}), "key 1 has other fields");
    for (const double bad : {0.0, -1.0, kNan, kInfinity}) {
        expectRefused(validateFocus({{{0.0, bad, {}, false}}}), "key 0");
        expectRefused(validateFocus({{{0.0, {}, bad, false}}}), "key 0");
    }
}

double focal(double yFov) {
    return 1.0 / std::tan(yFov / 2.0);
}

TEST_F(Lens, ALensPassesItsKeysAndHoldsStillBetweenEqualOnesToTheBit) {
    for (const auto interpolation : {PathInterpolation::Linear, PathInterpolation::CatmullRom}) {
        zoom({{0.0, 0.9}, {1.0, 0.4}, {3.0, 0.4}, {4.0, 1.2}}, interpolation);
        EXPECT_TRUE(mayZoom(mWorld, mCamera));
        EXPECT_EQ(viewAt(-1.0), 0.9);
        EXPECT_EQ(viewAt(0.0), 0.9);
        EXPECT_NE(viewAt(0.9), viewAt(1.0));
        EXPECT_NEAR(viewAt(1.0), 0.4, 1e-15);
        for (double t = 1.0; t <= 3.0; t += 0.125)
            EXPECT_EQ(viewAt(t), viewAt(1.0)) << t;
        EXPECT_EQ(viewAt(4.0), 1.2);
        EXPECT_EQ(viewAt(9.0), 1.2);
    }
    zoom({{0.0, 0.123}, {1.0, 0.123}, {2.0, 0.123}});
    EXPECT_FALSE(mayZoom(mWorld, mCamera));
    for (double t = -0.5; t < 2.5; t += 0.0173)
        ASSERT_EQ(viewAt(t), 0.123);
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    mWorld.registry.get<Camera>(mCamera).kind = CameraKind::Orthographic;
    EXPECT_FALSE(mayZoom(mWorld, mCamera)) << "it has no lens";
    EXPECT_EQ(viewAt(2.0), 0.7);
}

TEST_F(Lens, AStraightZoomMultipliesTheFocalLengthEvenlyOrEasesLikeAPath) {
    zoom({{0.0, 1.0}, {2.0, 0.3}}, PathInterpolation::Linear);
    const double ratio = focal(viewAt(0.5)) / focal(viewAt(0.0));
    EXPECT_GT(ratio, 1.0);
    for (const double t : {0.5, 1.0, 1.5})
        EXPECT_NEAR(focal(viewAt(t + 0.5)) / focal(viewAt(t)), ratio, 1e-12) << t;
    zoom({{0.0, 1.0}, {2.0, 0.3}}, PathInterpolation::Linear, PathEase::InOut);
    const double whole = std::log(focal(0.3) / focal(1.0));
    EXPECT_NEAR(std::log(focal(viewAt(0.5)) / focal(1.0)) / whole, 0.15625, 1e-12);
}

TEST_F(Lens, InterpolationBetweenTheWidestKeysIsAValidLens) {
    zoom({{0.0, 3.14}, {0.01, 1e-9}, {1.0, 1e-9}, {1.01, 3.14}, {5.0, 1e-3}});
    for (double t = -0.1; t < 5.2; t += 0.003) {
        ASSERT_GT(viewAt(t), 0.0) << t;
        ASSERT_LT(viewAt(t), std::numbers::pi) << t;
    }
}

TEST_F(Lens, ACutOfTheLensJumpsAndACutOfEitherLensOrPathHoldsItInThatFrame) {
    zoom({{0.0, 0.9}, {1.0, 0.8}, {2.0, 0.3, true}, {3.0, 0.2}});
    EXPECT_EQ(viewAt(1.999), 0.8);
    EXPECT_EQ(viewAt(2.0), 0.3);
    const auto& lens = mWorld.registry.get<LensMotion>(mCamera);
    EXPECT_TRUE(hasCutWithin(lens, 1.9, 2.0));
    EXPECT_FALSE(hasCutWithin(lens, 2.0, 2.1));
    PathMotion path;
    path.keys.resize(2);
    path.keys[1].seconds = 2.0;
    path.keys[1].cut = true;
    for (const bool isOfPath : {false, true}) {
        if (isOfPath) {
            zoom({{0.0, 0.9}, {4.0, 0.3}});
            mWorld.registry.add(mCamera, path);
        }
        const ExposureMotion cut = expose(0.1, 2.01);
        EXPECT_TRUE(cut.isCut());
        EXPECT_EQ(cut.cameraYFov(0.0), viewAt(2.01));
        EXPECT_EQ(cut.cameraYFov(1.0), viewAt(2.01));
        EXPECT_FALSE(cut.mayCameraZoom());
    }
    const ExposureMotion before = expose(0.1, 1.9);
    EXPECT_EQ(before.cameraYFov(0.0), viewAt(before.exposure().open));
    EXPECT_NE(before.cameraYFov(0.0), before.cameraYFov(1.0));
    EXPECT_TRUE(before.mayCameraZoom());
}

TEST_F(Lens, BlurByZoomingScalesWithThatByTurning) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    CameraShutter shutter{.exposureSeconds = 0.5};
    const auto lensAt = [&](double s) {
        return ExposureMotion(mWorld, mCamera, computeExposure(shutter, 2.0)).cameraYFov(s);
    };
    EXPECT_EQ(lensAt(0.0), viewAt(1.5));
    shutter.cameraRotationScale = 0.5;
    EXPECT_EQ(lensAt(0.0), viewAt(1.75));
    shutter.cameraRotationScale = 0.0;
    EXPECT_EQ(lensAt(0.0), viewAt(2.0));
}

TEST_F(Lens, ExcludedEntitiesFollowTheZoom) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    const ecs::Entity still = mWorld.registry.create();
    mWorld.registry.add(still, LocalTransform{{{1.0, 2.0, -5.0}, {1, 0, 0, 0}, math::dvec3(1.0)}});
    mWorld.registry.add(still, MotionBlur{.exclude = true});
    const ExposureMotion motion = expose(0.5, 2.0);
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

} // namespace
} // namespace shutter::scene
