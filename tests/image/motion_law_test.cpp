// SPDX-License-Identifier: MIT
// Motion vectors against closed forms in double precision. Each test casts the pixel's ray onto
// the surface it knows, moves that point (or the camera), and projects it at open and close.
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <cmath>
#include <functional>
#include <optional>

namespace shutter {
namespace {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;
using scene::ShutterPhase;
using test::Placement;
using test::SceneBuilder;
using test::Stage;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;
constexpr double kYFov = 0.9;
constexpr double kTolerancePx = 0.01; // pixels

constexpr ShutterPhase kPhases[] = {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End};

class MotionLaw : public test::GpuTest {};

/// A pinhole camera, written down without the engine's projection.
struct Pinhole {
    dmat4 worldFromView{1.0};

    static double focalPx() { return kHeight / 2.0 / std::tan(kYFov / 2.0); }

    [[nodiscard]] dvec3 directionOf(const dvec2& px) const {
        const dvec3 view((px.x - kWidth / 2.0), (kHeight / 2.0 - px.y), -focalPx());
        return math::dmat3(worldFromView) * view;
    }

    [[nodiscard]] dvec2 project(const dvec4& world) const {
        const dvec4 view = glm::inverse(worldFromView) * world;
        return {
            kWidth / 2.0 - focalPx() * view.x / view.z,
            kHeight / 2.0 + focalPx() * view.y / view.z};
    }
};

dmat4 poseAt(const Placement& placement, double seconds) {
    math::Transform transform;
    transform.translation = placement.position + placement.velocity * seconds;
    const double speed = glm::length(placement.angularVelocity);
    transform.rotation = placement.rotation;
    if (speed > 0.0)
        transform.rotation =
            glm::angleAxis(speed * seconds, placement.angularVelocity / speed) * placement.rotation;
    return math::computeMatrix(transform);
}

/// What is in the picture: at most one plane (the object's z = 0), and where the camera is.
struct Case {
    std::optional<Placement> plane;
    Placement camera{};
};

/// Motion a pixel must have, or nothing where its ray runs too near the quad's border to tell.
std::optional<dvec2>
expectedMotion(const Case& scene, const dvec2& px, const scene::ExposureInterval& exposure) {
    const Pinhole raster{poseAt(scene.camera, exposure.raster)};
    const Pinhole open{poseAt(scene.camera, exposure.open)};
    const Pinhole close{poseAt(scene.camera, exposure.close)};
    const dvec3 direction = raster.directionOf(px);
    if (!scene.plane) {
        const dvec4 infinite(direction, 0.0);
        return close.project(infinite) - open.project(infinite);
    }
    const dmat4 worldFromPlane = poseAt(*scene.plane, exposure.raster);
    const dvec3 origin = dvec3(raster.worldFromView[3]);
    const dvec3 normal = dvec3(worldFromPlane[2]);
    const double t =
        glm::dot(dvec3(worldFromPlane[3]) - origin, normal) / glm::dot(direction, normal);
    const dvec4 object = glm::inverse(worldFromPlane) * dvec4(origin + t * direction, 1.0);
    return close.project(poseAt(*scene.plane, exposure.close) * object) -
           open.project(poseAt(*scene.plane, exposure.open) * object);
}

/// Checks every pixel that shows the plane (or the sky, without one), in every phase.
void expectMotion(gpu::Device& device, const Case& known, double longerThanPx) {
    SceneBuilder builder;
    builder.setPerspective(kYFov);
    builder.moveCamera(known.camera);
    if (known.plane)
        builder.add(test::makeQuad(2.0, 1.5, builder.addColor({1, 1, 1})), *known.plane);
    Stage stage(device, builder);
    for (ShutterPhase phase : kPhases) {
        const auto result = stage.render(
            {.seconds = 0.2, .exposureSeconds = 0.5, .phase = phase, .aovs = {"motion", "mesh_id"}}
        );
        const image::Image& motion = result.intermediates.at("motion");
        const image::Image& ids = result.intermediates.at("mesh_id");
        const auto exposure = scene::computeExposure({0.5, phase}, 0.2);
        size_t compared = 0;
        double longest = 0.0;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                if ((ids.at(x, y, 0) >= 0.0f) != known.plane.has_value())
                    continue;
                const auto expected = expectedMotion(known, dvec2(x + 0.5, y + 0.5), exposure);
                ASSERT_NEAR(motion.at(x, y, 0), expected->x, kTolerancePx) << x << ", " << y;
                ASSERT_NEAR(motion.at(x, y, 1), expected->y, kTolerancePx) << x << ", " << y;
                longest = std::max(longest, glm::length(*expected));
                ++compared;
            }
        EXPECT_GT(compared, 200u) << "too few pixels to mean anything";
        EXPECT_GT(longest, longerThanPx);
    }
}

TEST_F(MotionLaw, ATranslationAtSeveralDepthsMovesByTheClosedForm) {
    for (double depth : {1.5, 3.0, 5.0})
        expectMotion(
            device(), {Placement{.position = {0, 0, -depth}, .velocity = {0.8, -0.3, 0.4}}}, 3.0
        );
}

TEST_F(MotionLaw, ATranslatedObliquePlaneMovesByTheClosedForm) {
    const auto turned = glm::angleAxis(0.9, glm::normalize(dvec3(0.3, 1.0, 0.2)));
    expectMotion(
        device(),
        {Placement{.position = {0.1, 0, -2}, .rotation = turned, .velocity = {0.8, 0.5, -0.6}}},
        5.0
    );
}

TEST_F(MotionLaw, ARotationAboutAnAxisMovesByTheClosedForm) {
    expectMotion(
        device(), {Placement{.position = {0, 0, -2.5}, .angularVelocity = {0, 0, 2.0}}}, 10.0
    );
    expectMotion(
        device(), {Placement{.position = {0, 0, -2.5}, .angularVelocity = {0.3, 0.8, -0.5}}}, 3.0
    );
}

TEST_F(MotionLaw, ACameraTranslationMovesWhatStandsStill) {
    expectMotion(
        device(),
        {Placement{.position = {0, 0, -2.5}},
         {.position = {0.1, 0, 0}, .velocity = {0.5, -0.2, -0.7}}},
        5.0
    );
}

TEST_F(MotionLaw, ACameraPanMovesWhatStandsStill) {
    expectMotion(
        device(), {Placement{.position = {0, 0, -2.5}}, {.angularVelocity = {0.1, 0.4, 0.2}}}, 5.0
    );
}

TEST_F(MotionLaw, ACameraPanMovesTheSky) {
    expectMotion(device(), {std::nullopt, {.angularVelocity = {0.1, 0.4, 0.2}}}, 5.0);
}

TEST_F(MotionLaw, ACameraTranslationLeavesTheSkyExactlyStill) {
    SceneBuilder builder;
    builder.setPerspective(kYFov);
    builder.moveCamera({.velocity = {3.0, 1.0, -2.0}});
    builder.add(test::makeQuad(1, 1, builder.addColor({1, 1, 1})), {.position = {0, 0, -4}});
    const auto result = test::renderOnce(device(), builder, {.aovs = {"motion", "mesh_id"}});
    const image::Image& motion = result.intermediates.at("motion");
    size_t sky = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            if (result.intermediates.at("mesh_id").at(x, y, 0) >= 0.0f)
                continue;
            ASSERT_EQ(motion.at(x, y, 0), 0.0f) << x << ", " << y;
            ASSERT_EQ(motion.at(x, y, 1), 0.0f) << x << ", " << y;
            ++sky;
        }
    EXPECT_GT(sky, 1000u);
}

TEST_F(MotionLaw, AStaticSceneUnderAStillCameraHasMotionExactlyZero) {
    SceneBuilder builder;
    builder.setPerspective(kYFov);
    // Far from the origin, turned: nothing in it is a round number.
    const dvec3 far(1234.5, -77.3, 9876.1);
    const auto turned = glm::angleAxis(0.7, glm::normalize(dvec3(0.2, 1.0, 0.4)));
    builder.moveCamera({.position = far, .rotation = turned});
    const auto white = builder.addColor({1, 1, 1});
    builder.add(test::makeSphere(0.7, white), {.position = far + turned * dvec3(0.3, 0.1, -3)});
    builder.add(test::makeBox({9, 0.1, 9}, white), {.position = far + turned * dvec3(0, -1, -4)});
    const auto result = test::renderOnce(device(), builder, {.aovs = {"motion", "mesh_id"}});
    const image::Image& motion = result.intermediates.at("motion");
    size_t drawn = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            ASSERT_EQ(motion.at(x, y, 0), 0.0f) << x << ", " << y;
            ASSERT_EQ(motion.at(x, y, 1), 0.0f) << x << ", " << y;
            drawn += result.intermediates.at("mesh_id").at(x, y, 0) >= 0.0f;
        }
    EXPECT_GT(drawn, 500u);
}

TEST_F(MotionLaw, MotionThroughTheCameraEndsWhereThePathLeavesThePicturesFront) {
    // From 2 m in front straight through the camera: a point at x goes outwards, from f x / 2 to
    // f x / near, and not to the mirrored place that a projection from behind would give.
    constexpr double kNear = 0.05;
    SceneBuilder builder;
    builder.setPerspective(kYFov, kNear);
    builder.add(
        test::makeQuad(1, 0.8, builder.addColor({1, 1, 1})),
        {.position = {0, 0, -2}, .velocity = {0, 0, 6}}
    );
    const auto result = test::renderOnce(
        device(), builder, {.phase = ShutterPhase::Start, .aovs = {"motion", "mesh_id"}}
    );
    const image::Image& motion = result.intermediates.at("motion");
    size_t compared = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            if (result.intermediates.at("mesh_id").at(x, y, 0) < 0.0f)
                continue;
            const dvec2 fromCentre(x + 0.5 - kWidth / 2.0, y + 0.5 - kHeight / 2.0);
            const dvec2 expected = fromCentre * (2.0 / kNear - 1.0);
            // Divided by a w of 0.05 that is the difference of numbers near 6 in single precision:
            // 6 * 2^-24 / 0.05, some 1e-5 of the place.
            const double tolerance = 1e-4 * glm::length(expected);
            ASSERT_NEAR(motion.at(x, y, 0), expected.x, tolerance) << x << ", " << y;
            ASSERT_NEAR(motion.at(x, y, 1), expected.y, tolerance) << x << ", " << y;
            ++compared;
        }
    EXPECT_GT(compared, 200u);
}

TEST_F(MotionLaw, AnObjectThatCrossesTheNearPlaneHasFiniteMotion) {
    for (ShutterPhase phase : kPhases) {
        SceneBuilder builder;
        builder.setPerspective(kYFov);
        // From 3 m in front to 3 m behind the camera, and past its side, or the other way round.
        const double towards = phase == ShutterPhase::End ? -1.0 : 1.0;
        builder.add(
            test::makeBox({1, 1, 1}, builder.addColor({1, 1, 1})),
            {.position = {0.2, 0.1, -2}, .velocity = towards * dvec3(0.5, 0.2, 6)}
        );
        const auto result = test::renderOnce(
            device(), builder, {.phase = phase, .aovs = {"motion", "depth", "mesh_id"}}
        );
        EXPECT_TRUE(test::allFinite(result.intermediates.at("motion")));
        const image::Image& motion = result.intermediates.at("motion");
        double longest = 0.0;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x)
                longest = std::max(
                    longest, std::hypot(double(motion.at(x, y, 0)), double(motion.at(x, y, 1)))
                );
        EXPECT_GT(longest, 20.0) << "it moves far across the picture";
        EXPECT_LE(longest, 32769.0) << "kMaxMotionPx and its rounding";
    }
}

} // namespace
} // namespace shutter
