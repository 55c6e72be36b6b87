// SPDX-License-Identifier: MIT
// Motion vectors against closed forms and against where finer pictures have the same point; a lens
// that zooms; mirrored scenes.
#include "engine/image/metrics.h"
#include "engine/scene/camera.h"
#include "engine/scene/path.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"
#include "tests/support/white_quads.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace shutter {
namespace {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;
using scene::ShutterPhase;
using test::Placement;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

constexpr uint32_t kMotionWidth = 96;
constexpr uint32_t kMotionHeight = 64;
constexpr double kMotionYFov = 0.9;
constexpr double kTolerancePx = 0.001; // pixels

constexpr ShutterPhase kPhases[] = {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End};

class MotionLaw : public test::GpuTest {};

/// A pinhole camera, written down without the engine's projection.
struct Pinhole {
    dmat4 worldFromView{1.0};

    static double focalPx() { return kMotionHeight / 2.0 / std::tan(kMotionYFov / 2.0); }

    [[nodiscard]] dvec3 directionOf(const dvec2& px) const {
        const dvec3 view((px.x - kMotionWidth / 2.0), (kMotionHeight / 2.0 - px.y), -focalPx());
        return math::dmat3(worldFromView) * view;
    }

    [[nodiscard]] dvec2 project(const dvec4& world) const {
        const dvec4 view = glm::inverse(worldFromView) * world;
        return {
            kMotionWidth / 2.0 - focalPx() * view.x / view.z,
            kMotionHeight / 2.0 + focalPx() * view.y / view.z};
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

/// The scene: at most one plane (the object's z = 0), and the camera's place.
struct Case {
    std::optional<Placement> plane;
    Placement camera{};
};

/// Motion a pixel must have, or nothing if its ray is too near to the quad's border.
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

/// How much the motion within half a step of the raster's grid from `px` differs from that at it:
/// rasters move vertices to the grid and interpolate from there.
dvec2 motionWithinStep(
    const gpu::Device& device,
    const Case& scene,
    const dvec2& px,
    const scene::ExposureInterval& exposure
) {
    const double half = std::ldexp(0.5, -int(device.limits().subPixelPrecisionBits));
    const auto centre = expectedMotion(scene, px, exposure);
    dvec2 most(0.0);
    for (const dvec2 corner : {dvec2(-1, -1), dvec2(-1, 1), dvec2(1, -1), dvec2(1, 1)})
        most = glm::max(
            most, glm::abs(*expectedMotion(scene, px + half * corner, exposure) - *centre)
        );
    return most;
}

/// Checks every pixel that shows the plane (or the sky, without one), in every phase.
void expectMotion(gpu::Device& device, const Case& known, double longerThanPx) {
    SceneBuilder builder;
    builder.setPerspective(kMotionYFov);
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
        for (uint32_t y = 0; y < kMotionHeight; ++y)
            for (uint32_t x = 0; x < kMotionWidth; ++x) {
                if ((ids.at(x, y, 0) >= 0.0f) != known.plane.has_value())
                    continue;
                const dvec2 px(x + 0.5, y + 0.5);
                const auto expected = expectedMotion(known, px, exposure);
                const dvec2 tolerance =
                    kTolerancePx + motionWithinStep(device, known, px, exposure);
                ASSERT_NEAR(motion.at(x, y, 0), expected->x, tolerance.x) << x << ", " << y;
                ASSERT_NEAR(motion.at(x, y, 1), expected->y, tolerance.y) << x << ", " << y;
                longest = std::max(longest, glm::length(*expected));
                ++compared;
            }
        EXPECT_GT(compared, 200u) << "too few pixels to mean anything";
        EXPECT_GT(longest, longerThanPx);
    }
}

TEST_F(MotionLaw, MotionOfObjectsAndCameraFollowsTheClosedForm) {
    const auto oblique = glm::angleAxis(0.9, glm::normalize(dvec3(0.3, 1.0, 0.2)));
    const Placement still{.position = {0, 0, -2.5}};
    const Placement pan{.angularVelocity = {0.1, 0.4, 0.2}};
    for (const double depth : {1.5, 3.0, 5.0})
        expectMotion(
            device(), {Placement{.position = {0, 0, -depth}, .velocity = {0.8, -0.3, 0.4}}}, 3.0
        );
    expectMotion(
        device(),
        {Placement{.position = {0.1, 0, -2}, .rotation = oblique, .velocity = {0.8, 0.5, -0.6}}},
        5.0
    );
    expectMotion(
        device(), {Placement{.position = {0, 0, -2.5}, .angularVelocity = {0, 0, 2.0}}}, 10.0
    );
    expectMotion(
        device(), {Placement{.position = {0, 0, -2.5}, .angularVelocity = {0.3, 0.8, -0.5}}}, 3.0
    );
    expectMotion(device(), {still, {.position = {0.1, 0, 0}, .velocity = {0.5, -0.2, -0.7}}}, 5.0);
    expectMotion(device(), {still, pan}, 5.0);
    expectMotion(device(), {std::nullopt, pan}, 5.0); // the sky
}

/// \return how many pixels of the sky, or of all else, have motion exactly zero; any other fails
size_t countStill(gpu::Device& device, const SceneBuilder& scene, bool isSky) {
    const auto result = test::renderOnce(device, scene, {.aovs = {"motion", "mesh_id"}});
    const image::Image& motion = result.intermediates.at("motion");
    size_t still = 0;
    for (uint32_t y = 0; y < kMotionHeight; ++y)
        for (uint32_t x = 0; x < kMotionWidth; ++x) {
            if ((result.intermediates.at("mesh_id").at(x, y, 0) < 0.0f) != isSky)
                continue;
            EXPECT_EQ(motion.at(x, y, 0), 0.0f) << x << ", " << y;
            EXPECT_EQ(motion.at(x, y, 1), 0.0f) << x << ", " << y;
            ++still;
        }
    return still;
}

TEST_F(MotionLaw, ACameraTranslationLeavesTheSkyExactlyStill) {
    SceneBuilder builder;
    builder.setPerspective(kMotionYFov);
    builder.moveCamera({.velocity = {3.0, 1.0, -2.0}});
    builder.add(test::makeQuad(1, 1, builder.addColor({1, 1, 1})), {.position = {0, 0, -4}});
    EXPECT_GT(countStill(device(), builder, true), 1000u);
}

TEST_F(MotionLaw, AStaticSceneUnderAStillCameraHasMotionExactlyZero) {
    SceneBuilder builder;
    builder.setPerspective(kMotionYFov);
    // Far from the origin, turned: nothing in it is a round number.
    const dvec3 far(1234.5, -77.3, 9876.1);
    const auto turned = glm::angleAxis(0.7, glm::normalize(dvec3(0.2, 1.0, 0.4)));
    builder.moveCamera({.position = far, .rotation = turned});
    const auto white = builder.addColor({1, 1, 1});
    builder.add(test::makeSphere(0.7, white), {.position = far + turned * dvec3(0.3, 0.1, -3)});
    builder.add(test::makeBox({9, 0.1, 9}, white), {.position = far + turned * dvec3(0, -1, -4)});
    EXPECT_GT(countStill(device(), builder, false), 500u);
    EXPECT_GT(countStill(device(), builder, true), 500u);
}

TEST_F(MotionLaw, MotionThroughTheCameraEndsWhereThePathLeavesThePicturesFront) {
    // From 2 m in front straight through the camera: a point at x goes outwards, from f x / 2 to
    // f x / near, and not to the mirrored place that a projection from behind would give.
    constexpr double kNear = 0.05;
    SceneBuilder builder;
    builder.setPerspective(kMotionYFov, kNear);
    builder.add(
        test::makeQuad(1, 0.8, builder.addColor({1, 1, 1})),
        {.position = {0, 0, -2}, .velocity = {0, 0, 6}}
    );
    const auto result = test::renderOnce(
        device(), builder, {.phase = ShutterPhase::Start, .aovs = {"motion", "mesh_id"}}
    );
    const image::Image& motion = result.intermediates.at("motion");
    size_t compared = 0;
    for (uint32_t y = 0; y < kMotionHeight; ++y)
        for (uint32_t x = 0; x < kMotionWidth; ++x) {
            if (result.intermediates.at("mesh_id").at(x, y, 0) < 0.0f)
                continue;
            const dvec2 fromCentre(x + 0.5 - kMotionWidth / 2.0, y + 0.5 - kMotionHeight / 2.0);
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

class NestedMotionLaw : public test::GpuTest {
  protected:
    static void expectMotion(const SceneBuilder& scene, double longerThanPx) {
        Stage stage(device(), scene);
        for (const auto phase : {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End})
            test::expectMotionOfMarker(
                stage, {.seconds = 0.3, .exposureSeconds = 0.2, .phase = phase}, longerThanPx
            );
    }

    static ecs::Entity addPivot(SceneBuilder& scene, const test::Placement& placement) {
        const ecs::Entity entity = scene.world.registry.create();
        scene.world.registry.add(
            entity, scene::LocalTransform{{placement.position, placement.rotation, dvec3(1.0)}}
        );
        scene.world.registry.add(entity, scene::LinearVelocity{placement.velocity});
        scene.world.registry.add(entity, scene::AngularVelocity{placement.angularVelocity});
        return entity;
    }
};

TEST_F(NestedMotionLaw, APlaceOnTheWheelOfADrivingCar) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const ecs::Entity car = addPivot(
        scene,
        {.position = {-0.6, 0, -4},
         .rotation = glm::angleAxis(0.2, dvec3(0, 1, 0)),
         .velocity = {2.0, 0, 0.5},
         .angularVelocity = {0, 0.4, 0}}
    );
    const ecs::Entity wheel =
        addPivot(scene, {.position = {0.4, -0.3, 0.3}, .angularVelocity = {0, 0, -4.0}});
    scene.world.registry.add(wheel, scene::Parent{car});
    const ecs::Entity place = test::addMarker(scene, 0.3, {.position = {0.35, 0.1, 0}});
    scene.world.registry.add(place, scene::Parent{wheel});
    expectMotion(scene, 3.0);
}

TEST_F(NestedMotionLaw, AStillPlaceSeenFromACarThatTurns) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const ecs::Entity car =
        addPivot(scene, {.velocity = {1.0, 0, -2.0}, .angularVelocity = {0, -0.5, 0}});
    scene.world.registry.add(scene.camera, scene::Parent{car});
    scene.moveCamera({.position = {0.2, 0.5, 0.1}, .angularVelocity = {0.1, 0, 0.3}});
    (void)test::addMarker(scene, 0.3, {.position = {0.6, 0.6, -4}});
    expectMotion(scene, 3.0);
}

TEST_F(NestedMotionLaw, APlaceOnTheCarThatCarriesTheCamera) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const ecs::Entity car =
        addPivot(scene, {.velocity = {30.0, 0, -20.0}, .angularVelocity = {0, 2.0, 0}});
    scene.world.registry.add(scene.camera, scene::Parent{car});
    const ecs::Entity wiper =
        addPivot(scene, {.position = {0, -0.5, -2}, .angularVelocity = {0, 0, 3.0}});
    scene.world.registry.add(wiper, scene::Parent{car});
    const ecs::Entity place = test::addMarker(scene, 0.2, {.position = {0.2, 0.6, 0}});
    scene.world.registry.add(place, scene::Parent{wiper});
    expectMotion(scene, 3.0);
}

TEST_F(NestedMotionLaw, APlaceOnAPathSeenFromAPath) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const auto makePath = [](const dvec3& far) {
        scene::PathMotion path;
        for (int i = 0; i < 4; ++i) {
            scene::PathKey key;
            key.seconds = 0.2 * i;
            key.position = far + dvec3(0.3 * i, i % 2 == 0 ? 0.0 : 0.2, 0.1 * i);
            path.keys.push_back(key);
        }
        return path;
    };
    scene::PathMotion seen = makePath({-0.4, 0, -4});
    scene::PathMotion from = makePath({-0.2, 0.1, 0.5});
    for (scene::PathKey& key : from.keys)
        key.lookAt = dvec3(0.1, 0, -4) + 0.2 * key.seconds;
    const ecs::Entity place = test::addMarker(scene, 0.4, {});
    scene.world.registry.add(place, seen);
    scene.world.registry.add(scene.camera, from);
    expectMotion(scene, 1.0);
}

class ZoomLaw : public test::RayTest {};

/// A wall and a box before it, of which the lens sees less and less.
SceneBuilder makeZoom() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.world.registry.add(
        scene.camera,
        scene::LensMotion{
            {{-1.0, 1.1}, {-0.2, 0.95}, {0.3, 0.85}, {1.0, 0.7}},
            scene::PathInterpolation::CatmullRom,
            scene::PathEase::None}
    );
    scene.add(test::makeQuad(9, 7, scene.addWaves()), {.position = {0, 0, -5}});
    scene.add(
        test::makeBox({0.5, 0.4, 0.4}, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0.5, 0.3, -2.5}, .angularVelocity = {0.1, 0.3, 0.2}}
    );
    return scene;
}

TEST_F(ZoomLaw, RaysAndInstantsAgree) {
    SceneBuilder scene = makeZoom();
    Stage stage(device(), scene);
    test::expectTruthsAgree(stage, {.width = 64, .height = 48}, 35.0);
    // While the camera moves and turns, too.
    scene.moveCamera({.velocity = {0.2, 0.05, -0.3}, .angularVelocity = {0.02, 0.25, 0.1}});
    test::expectTruthsAgree(stage, {.width = 64, .height = 48}, 35.0);
}

TEST_F(ZoomLaw, MotionVectorsAreRadialAtEveryDepthAndInTheSky) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.world.registry.add(
        scene.camera, scene::LensMotion{{{-1.0, 1.1}, {1.0, 0.7}}, {}, scene::PathEase::None}
    );
    // Two depths, and around them nothing.
    scene.add(test::makeQuad(2, 2, scene.addColor({0.5f, 0.5f, 0.5f})), {.position = {0, 0, -5}});
    scene.add(test::makeQuad(0.4, 0.4, scene.addColor({1, 1, 1})), {.position = {0.1, 0, -2}});
    Stage stage(device(), scene);
    const auto drawn = stage.render({.exposureSeconds = 0.5, .aovs = {"motion", "mesh_id"}});
    const image::Image& motion = drawn.intermediates.at("motion");
    const auto halfExtent = [&](double seconds) {
        return std::tan(scene::yFovAt(scene.world, scene.camera, seconds) / 2.0);
    };
    // A place p from the middle is seen at p tan(raster) / tan(then).
    const double stretch = halfExtent(0.0) / halfExtent(0.25) - halfExtent(0.0) / halfExtent(-0.25);
    EXPECT_GT(stretch, 0.05);
    std::set<float> ids;
    for (uint32_t y = 0; y < kMotionHeight; ++y)
        for (uint32_t x = 0; x < kMotionWidth; ++x) {
            const math::dvec2 place(x + 0.5 - kMotionWidth / 2.0, y + 0.5 - kMotionHeight / 2.0);
            // Stored as half floats.
            const double tolerance = 1e-3 + 1e-3 * glm::length(place) * stretch;
            ASSERT_NEAR(motion.at(x, y, 0), place.x * stretch, tolerance) << x << " " << y;
            ASSERT_NEAR(motion.at(x, y, 1), place.y * stretch, tolerance) << x << " " << y;
            ids.insert(drawn.intermediates.at("mesh_id").at(x, y, 0));
        }
    EXPECT_EQ(ids.size(), 3u) << "both quads and the sky were seen";
}

TEST_F(ZoomLaw, ACutOfThePathAlsoCutsTheLens) {
    SceneBuilder scene = makeZoom();
    Stage stage(device(), scene);
    const auto draw = [&](std::string_view method,
                          double frameSeconds = scene::kStillFrameSeconds) {
        return stage.render({.method = method, .frameSeconds = frameSeconds}).color;
    };
    // A frame of no duration has no exposure.
    EXPECT_FALSE(test::sameBits(draw("hybrid"), draw("hybrid", 0.0)));
    scene::PathMotion path;
    path.keys.resize(2);
    path.keys[0].seconds = -9.0;
    path.keys[1].cut = true; // at 0, the raster instant
    scene.world.registry.add(scene.camera, path);
    for (const std::string_view method : {"hybrid", "accumulate", "truth"})
        EXPECT_TRUE(test::sameBits(draw(method), draw(method, 0.0))) << method;
}

class MirrorLaw : public test::GpuTest {};

constexpr uint32_t kTilePx = 16;
constexpr double kSpeedPx = 11.3;
constexpr double kMiddlePx = -13.3; // of the rectangle that moves, from the picture's
constexpr double kWidthPx = 21.3;
constexpr uint32_t kMotionInstants = 17;

/// Two flat rectangles before a flat wall; `side` -1 mirrors places and motion. Silhouettes lie off
/// the pixel centres, so that coverage has no ties.
SceneBuilder makeSided(double side) {
    SceneBuilder scene;
    scene.setPixelView(64);
    scene.add(
        test::makeQuad(70.5, 50.5, scene.addColor({0.2f, 0.6f, 0.3f})),
        {.position = {side * 4.1, 0, -20}}
    );
    scene.add(
        test::makeQuad(kWidthPx, 30.6, scene.addColor({0.9f, 0.1f, 0.4f})),
        {.position = {side * kMiddlePx, 3.1, -10}, .velocity = {side * kSpeedPx, 0, 0}}
    );
    return scene;
}

/// Two devices of thought, one picture: the taps of both must read the same texels. A tap lies at
/// u of the motion, (i + 1/2) / 15 + s_r - 1 (Jimenez's pairs: / 16) or (i + 1) / 16 + s_r - 1;
/// none may come so near to a border between texels that rounding decides.
void expectTapsAwayFromTexelBorders(double rasterTime) {
    for (int i = 0; i < 16; ++i)
        for (double u : {(i + 0.5) / 15.0, (i + 0.5) / 16.0, (i + 1.0) / 16.0}) {
            const double at = 0.5 + kSpeedPx * (u + rasterTime - 1.0);
            ASSERT_GT(std::abs(at - std::round(at)), 1e-3) << "tap " << i;
        }
}

/// Rasters move vertices to the nearest place of a grid, whose step may be 1/16 px at most
/// (VkPhysicalDeviceLimits::subPixelPrecisionBits): at none of the instants may that bring a
/// silhouette to a pixel centre.
void expectSilhouettesAwayFromPixelCentres(const scene::ExposureInterval& exposure) {
    for (uint32_t i = 0; i < kMotionInstants; ++i)
        for (const double side : {-0.5, 0.5}) {
            const double seconds =
                glm::mix(exposure.open, exposure.close, (i + 0.5) / kMotionInstants);
            const double at =
                kMotionWidth / 2.0 + kMiddlePx + side * kWidthPx + kSpeedPx * seconds - 0.5;
            ASSERT_GT(std::abs(at - std::round(at)), 1.0 / 16.0) << "instant " << i;
        }
}

TEST_F(MirrorLaw, AMirroredSceneAndAMirroringCameraMakeTheMirroredPicture) {
    const SceneBuilder scene = makeSided(1.0);
    const SceneBuilder mirrored = makeSided(-1.0);
    SceneBuilder mirroring = makeSided(1.0);
    mirroring.cameraSettings().xMag = -1.0; // its width is that of the picture
    Stage stage(device(), scene);
    Stage mirroredStage(device(), mirrored);
    Stage mirroringStage(device(), mirroring);
    for (const std::string_view method : test::listRasterMethods(device()))
        for (const auto phase : {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End}) {
            const scene::ExposureInterval exposure = scene::computeExposure({1.0, phase}, 0.0);
            expectTapsAwayFromTexelBorders(exposure.rasterTime);
            expectSilhouettesAwayFromPixelCentres(exposure);
            Shot shot{
                .method = method,
                .phase = phase,
                .background = math::vec3(0.05f),
                .instants = kMotionInstants};
            shot.settings.jitter = 0.0f;
            shot.settings.raysPerPixel = 0.0f;  // which samples get them depends on the pixel
            shot.settings.tileSizePx = kTilePx; // 96 and 64 are multiples
            const auto direct = stage.render(shot);
            for (Stage* other : {&mirroredStage, &mirroringStage}) {
                const auto across = other->render(shot);
                // The same sums in another order of taps: rounding to half floats may fall to the
                // other side, a unit in the last place of values below 1 (2^-11).
                EXPECT_LE(
                    image::computeMaxDifference(direct.color, test::mirror(across.color)),
                    1.0 / 2048.0
                ) << method
                  << int(phase);
                // And the picture is not its own mirror image, which would prove nothing.
                EXPECT_GT(image::computeMaxDifference(direct.color, across.color), 0.1);
            }
        }
}

class MirrorRayLaw : public test::RayTest {};

TEST_F(MirrorRayLaw, MaskAndRevealAreMirroredBitForBit) {
    Shot shot{.method = "hybrid", .aovs = {"mask", "reveal"}};
    shot.settings.tileSizePx = kTilePx;
    const auto direct = test::renderOnce(device(), makeSided(1.0), shot);
    const auto across = test::renderOnce(device(), makeSided(-1.0), shot);
    ASSERT_GT(test::countSet(direct.intermediates.at("mask")), 100u);
    for (const char* name : {"mask", "reveal"})
        EXPECT_TRUE(test::sameBits(
            direct.intermediates.at(name), test::mirror(across.intermediates.at(name))
        )) << name;
}

} // namespace
} // namespace shutter
