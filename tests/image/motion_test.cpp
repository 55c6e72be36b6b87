// SPDX-License-Identifier: MIT
// Motion vectors against closed forms and against where finer pictures have the same point; a lens
// that zooms; mirrored scenes; everything that can move a surface, on real models.
#include "engine/gltf/gltf_loader.h"
#include "engine/image/metrics.h"
#include "engine/scene/animation.h"
#include "engine/scene/camera.h"
#include "engine/scene/deformation.h"
#include "engine/scene/path.h"
#include "tests/image/laws.h"
#include "tests/support/expected_motion.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"
#include "tests/support/white_quads.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

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
    SceneBuilder builder = test::makeView(kMotionYFov);
    builder.moveCamera(known.camera);
    if (known.plane)
        test::addCard(builder, {2.0, 1.5}, {1, 1, 1}, *known.plane);
    Stage stage(device, builder);
    for (const ShutterPhase phase : test::kPhases) {
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
    SceneBuilder builder = test::makeView(kMotionYFov);
    builder.moveCamera({.velocity = {3.0, 1.0, -2.0}});
    test::addCard(builder, {1, 1}, {1, 1, 1}, {.position = {0, 0, -4}});
    EXPECT_GT(countStill(device(), builder, true), 1000u);
}

TEST_F(MotionLaw, AStaticSceneUnderAStillCameraHasMotionExactlyZero) {
    SceneBuilder builder = test::makeView(kMotionYFov);
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
    SceneBuilder builder = test::makeView(kMotionYFov, kNear);
    test::addCard(builder, {1, 0.8}, {1, 1, 1}, {.position = {0, 0, -2}, .velocity = {0, 0, 6}});
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

void expectMotion(const SceneBuilder& scene, double longerThanPx) {
    Stage stage(test::sharedDevice(), scene);
    for (const auto phase : test::kPhases)
        test::expectMotionOfMarker(
            stage, {.seconds = 0.3, .exposureSeconds = 0.2, .phase = phase}, longerThanPx
        );
}

ecs::Entity addPivot(SceneBuilder& scene, const test::Placement& placement) {
    const ecs::Entity entity = scene.world.registry.create();
    scene.place(entity, placement);
    return entity;
}

TEST_F(MotionLaw, MotionIsTheDisplacementOfAPlaceOnTheWheelOfADrivingCar) {
    SceneBuilder scene = test::makeView();
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

TEST_F(MotionLaw, MotionIsTheDisplacementOfAStillPlaceSeenFromACarThatTurns) {
    SceneBuilder scene = test::makeView();
    const ecs::Entity car =
        addPivot(scene, {.velocity = {1.0, 0, -2.0}, .angularVelocity = {0, -0.5, 0}});
    scene.world.registry.add(scene.camera, scene::Parent{car});
    scene.moveCamera({.position = {0.2, 0.5, 0.1}, .angularVelocity = {0.1, 0, 0.3}});
    (void)test::addMarker(scene, 0.3, {.position = {0.6, 0.6, -4}});
    expectMotion(scene, 3.0);
}

TEST_F(MotionLaw, MotionIsTheDisplacementOfAPlaceOnTheCarThatCarriesTheCamera) {
    SceneBuilder scene = test::makeView();
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

TEST_F(MotionLaw, MotionIsTheDisplacementOfAPlaceOnAPathSeenFromAPath) {
    SceneBuilder scene = test::makeView();
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

class MotionRayLaw : public test::RayTest {};

/// A wall and a box before it, of which the lens sees less and less.
SceneBuilder makeZoom() {
    SceneBuilder scene = test::makeWavyRoom(5.0, 9.0, 7.0);
    scene.world.registry.add(
        scene.camera,
        scene::LensMotion{
            {{-1.0, 1.1}, {-0.2, 0.95}, {0.3, 0.85}, {1.0, 0.7}},
            scene::PathInterpolation::CatmullRom,
            scene::PathEase::None}
    );
    test::addBox(
        scene,
        {0.5, 0.4, 0.4},
        {0.9f, 0.2f, 0.1f},
        {.position = {0.5, 0.3, -2.5}, .angularVelocity = {0.1, 0.3, 0.2}}
    );
    return scene;
}

TEST_F(MotionRayLaw, RaysAndInstantsAgreeUnderAZoom) {
    SceneBuilder scene = makeZoom();
    Stage stage(device(), scene);
    test::expectTruthsAgree(stage, {.width = 64, .height = 48}, 35.0);
    // While the camera moves and turns, too.
    scene.moveCamera({.velocity = {0.2, 0.05, -0.3}, .angularVelocity = {0.02, 0.25, 0.1}});
    test::expectTruthsAgree(stage, {.width = 64, .height = 48}, 35.0);
}

TEST_F(MotionRayLaw, MotionVectorsOfAZoomAreRadialAtEveryDepthAndInTheSky) {
    SceneBuilder scene = test::makeView();
    scene.world.registry.add(
        scene.camera, scene::LensMotion{{{-1.0, 1.1}, {1.0, 0.7}}, {}, scene::PathEase::None}
    );
    // Two depths, and around them nothing.
    test::addCard(scene, {2, 2}, {0.5f, 0.5f, 0.5f}, {.position = {0, 0, -5}});
    test::addCard(scene, {0.4, 0.4}, {1, 1, 1}, {.position = {0.1, 0, -2}});
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

TEST_F(MotionRayLaw, ACutOfThePathAlsoCutsTheLens) {
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

constexpr uint32_t kTilePx = 16;
constexpr double kSpeedPx = 11.3;
constexpr double kMiddlePx = -13.3; // of the rectangle that moves, from the picture's
constexpr double kWidthPx = 21.3;
constexpr uint32_t kMotionInstants = 17;

/// Two flat rectangles before a flat wall; `side` -1 mirrors places and motion. Silhouettes lie off
/// the pixel centres, so that coverage has no ties.
SceneBuilder makeSided(double side) {
    SceneBuilder scene = test::makePixelView(64);
    test::addCard(scene, {70.5, 50.5}, {0.2f, 0.6f, 0.3f}, {.position = {side * 4.1, 0, -20}});
    test::addCard(
        scene,
        {kWidthPx, 30.6},
        {0.9f, 0.1f, 0.4f},
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

TEST_F(MotionLaw, AMirroredSceneAndAMirroringCameraMakeTheMirroredPicture) {
    const SceneBuilder scene = makeSided(1.0);
    const SceneBuilder mirrored = makeSided(-1.0);
    SceneBuilder mirroring = makeSided(1.0);
    mirroring.cameraSettings().xMag = -1.0; // its width is that of the picture
    Stage stage(device(), scene);
    Stage mirroredStage(device(), mirrored);
    Stage mirroringStage(device(), mirroring);
    // Instants, a filter that looks beside its pixel, and lookups.
    for (const std::string_view method : test::pickMethods(
             test::listRasterMethods(device()), {"accumulate", "guertin2014", "resolved"}
         ))
        for (const auto phase : test::kPhases) {
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

TEST_F(MotionRayLaw, MaskAndRevealAreMirroredBitForBit) {
    Shot shot{.method = "hybrid", .aovs = {"mask", "reveal"}};
    shot.settings.jitter = 0.0f; // taps that miss the raster are the mask
    shot.settings.tileSizePx = kTilePx;
    const auto direct = test::renderOnce(device(), makeSided(1.0), shot);
    const auto across = test::renderOnce(device(), makeSided(-1.0), shot);
    ASSERT_GT(test::countSet(direct.intermediates.at("mask")), 100u);
    for (const char* name : {"mask", "reveal"})
        EXPECT_TRUE(test::sameBits(
            direct.intermediates.at(name), test::mirror(across.intermediates.at(name))
        )) << name;
}

struct Model {
    const char* name;
    const char* file; ///< below scenes/gltf-samples
    double seconds;   ///< of the raster instant, inside of the clip
    double exposureSeconds;
    double yaw = 0.0;      ///< of the camera round the model, radians; 0: from +Z
    dvec3 velocity{0.0};   ///< of the whole model besides its clips, m/s
    double mostLost = 1.0; ///< dB below the rigid mover
};

void PrintTo(const Model& model, std::ostream* out) {
    *out << model.name;
}

const Model kModels[] = {
    {"Skin", "CesiumMan/CesiumMan.glb", 0.6, 0.08},
    {"FastSkin", "Fox/Fox.gltf", 0.35, 0.06},
    // Legs that cross in opposite directions inside of one tile, which knows one dominant motion:
    // 3.2 and 3.6 dB below the rigid mover come from the method, more than the 1 dB allowed to
    // others.
    {"FastSkinFromItsSide", "Fox/Fox.gltf", 0.35, 0.06, 1.3, dvec3(0.0), 4.0},
    {"Morph", "MorphStressTest/MorphStressTest.glb", 0.7, 0.1},
    {"Interpolation", "InterpolationTest/InterpolationTest.glb", 1.3, 0.08},
    {"SpinningWheels", "CesiumMilkTruck/CesiumMilkTruck.glb", 0.5, 0.08, 1.3},
    // Rolls without slipping. Wheels and body move differently inside of one tile, which knows one
    // dominant motion: the error of the paper's gather there is 1.3 to 1.4 dB.
    {"RollingTruck", "CesiumMilkTruck/CesiumMilkTruck.glb", 0.5, 0.08, 1.3, {0, 0, 2.15}, 1.5},
};

constexpr uint32_t kSourceWidth = 320;
constexpr uint32_t kSourceHeight = 180;

/// Stops every clip in its pose at `seconds`.
void freeze(scene::World& world, double seconds) {
    std::vector<ecs::Entity> entities;
    for (const ecs::Entity entity : world.registry.entities())
        entities.push_back(entity);
    for (const ecs::Entity entity : entities) {
        if (auto* morph = world.registry.find<scene::MorphWeights>(entity)) {
            const auto weights = scene::deformationAt(world, entity, seconds).morphWeights;
            morph->weights.assign(weights.begin(), weights.end());
            morph->channels.clear();
        }
        if (const auto* animated = world.registry.find<scene::Animated>(entity)) {
            auto& local = world.registry.get<scene::LocalTransform>(entity);
            local.transform = scene::sampleAnimated(
                world.assets, world.playback, *animated, local.transform, seconds
            );
            world.registry.remove<scene::Animated>(entity);
        }
    }
}

/// All that is drawn slides, each entity through its own place at `seconds`.
void slide(scene::World& world, double seconds, const dvec3& metresPerSecond) {
    std::vector<ecs::Entity> roots;
    for (const ecs::Entity entity : world.registry.entities())
        if (!world.registry.has<scene::Parent>(entity) &&
            !world.registry.has<scene::Camera>(entity) && !world.registry.has<scene::Light>(entity))
            roots.push_back(entity);
    for (const ecs::Entity root : roots) {
        const auto* before = world.registry.find<scene::LinearVelocity>(root);
        const dvec3 faster = metresPerSecond - (before ? before->metresPerSecond : dvec3(0.0));
        world.registry.add(root, scene::LinearVelocity{metresPerSecond});
        if (auto* matrix = world.registry.find<scene::LocalMatrix>(root)) {
            matrix->matrix[3] -= math::dvec4(faster * seconds, 0.0);
            continue;
        }
        auto* local = world.registry.find<scene::LocalTransform>(root);
        if (!local)
            local = &world.registry.add<scene::LocalTransform>(root);
        local->transform.translation -= faster * seconds;
    }
}

class MotionSources : public test::GpuTest, public ::testing::WithParamInterface<Model> {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped())
            return;
        const auto path =
            std::filesystem::path(SHUTTER_SHARED_DIR) / "scenes/gltf-samples" / GetParam().file;
        if (!std::filesystem::exists(path))
            GTEST_SKIP() << "the scenes are not available (" << path.filename() << ")";
        auto loaded = gltf::loadGltf(path);
        ASSERT_TRUE(loaded) << loaded.error().message;
        mScene.world = std::move(loaded.value().world);
        mScene.camera = scene::addFramingCamera(
            mScene.world, double(kSourceWidth) / kSourceHeight, GetParam().seconds
        );
        walkRound(GetParam().yaw);
        slide(mScene.world, GetParam().seconds, GetParam().velocity);
        mScene.addSun({-0.3, -1.0, -0.5}, 2.0f);
    }

    void walkRound(double yaw) {
        const dvec3 centre = scene::computeWorldBounds(mScene.world, GetParam().seconds).centre();
        const math::dquat turn = glm::angleAxis(yaw, dvec3(0, 1, 0));
        math::Transform& camera =
            mScene.world.registry.get<scene::LocalTransform>(mScene.camera).transform;
        camera.translation = centre + turn * (camera.translation - centre);
        camera.rotation = turn * camera.rotation;
    }

    [[nodiscard]] static Shot makeShot(std::string_view method) {
        Shot shot;
        shot.method = method;
        shot.width = kSourceWidth;
        shot.height = kSourceHeight;
        shot.seconds = GetParam().seconds;
        shot.exposureSeconds = GetParam().exposureSeconds;
        shot.background = math::vec3(0.18f);
        shot.ambient = math::vec3(0.25f);
        shot.instants = 96;
        return shot;
    }

    [[nodiscard]] static Shot makePaperShot(std::string_view method) {
        Shot shot = makeShot(method);
        shot.settings = motion_blur::paperSettings();
        return shot;
    }

    SceneBuilder mScene;
};

/// Covered and far enough from any silhouette for the two rasterisers to mean the same surface.
bool isInside(const image::Image& motion, const test::ExpectedMotion& expected, int x, int y) {
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const auto nx = uint32_t(x + dx);
            const auto ny = uint32_t(y + dy);
            const auto& pixel = expected.at(nx, ny);
            if (!pixel || std::abs(pixel->depth / double(motion.at(nx, ny, 2)) - 1.0) > 1e-3)
                return false;
        }
    return true;
}

TEST_P(MotionSources, MotionVectorsAreDifferencesOfRasterisedPositions) {
    Shot shot = makeShot("sharp");
    shot.aovs = {"motion"};
    const auto result = test::renderOnce(device(), mScene, shot);
    const image::Image& motion = result.intermediates.at("motion");
    const auto exposure = scene::computeExposure({shot.exposureSeconds, shot.phase}, shot.seconds);
    const test::ExpectedMotion expected(
        mScene.world, mScene.camera, exposure, kSourceWidth, kSourceHeight
    );
    size_t inside = 0;
    double longest = 0.0;
    double worst = 0.0;
    for (int y = 1; y + 1 < int(kSourceHeight); ++y)
        for (int x = 1; x + 1 < int(kSourceWidth); ++x) {
            if (!isInside(motion, expected, x, y))
                continue;
            const dvec2 actual(
                motion.at(uint32_t(x), uint32_t(y), 0), motion.at(uint32_t(x), uint32_t(y), 1)
            );
            const dvec2 truth = expected.at(uint32_t(x), uint32_t(y))->motion;
            worst = std::max(worst, glm::length(actual - truth));
            longest = std::max(longest, glm::length(truth));
            ++inside;
        }
    EXPECT_GT(inside, 1200u);
    EXPECT_GT(longest, 4.0);
    EXPECT_LE(worst, 0.05);
}

/// Where a motion reaches: tiles whose neighbourhood moves.
bool isReached(const image::Image& tiles, uint32_t x, uint32_t y) {
    constexpr uint32_t kTile = 40;
    return std::hypot(tiles.at(x / kTile, y / kTile, 0), tiles.at(x / kTile, y / kTile, 1)) > 0.5;
}

/// dB over the pixels that a motion reaches.
double computeReachedPsnr(
    const image::Image& picture, const image::Image& truth, const image::Image& tiles
) {
    double sum = 0.0;
    double count = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            if (!isReached(tiles, x, y))
                continue;
            for (uint32_t c = 0; c < 3; ++c)
                sum += std::pow(double(picture.at(x, y, c)) - double(truth.at(x, y, c)), 2.0);
            count += 3.0;
        }
    return 10.0 * std::log10(count / sum);
}

/// Root mean square of the motion of covered pixels that move, px.
double measureSpeed(const image::Image& motion) {
    double sum = 0.0;
    double count = 0.0;
    for (uint32_t y = 0; y < motion.height; ++y)
        for (uint32_t x = 0; x < motion.width; ++x) {
            const double speed = std::hypot(motion.at(x, y, 0), motion.at(x, y, 1));
            if (speed < 0.5)
                continue;
            sum += speed * speed;
            count += 1.0;
        }
    return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

TEST_P(MotionSources, BlurIsAsNearToTruthAsOnARigidMoverOfTheSameSpeed) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << device().info().name << " has no ray queries";

    struct Scores {
        double speed = 0.0;
        double gather = 0.0;
        double hybrid = 0.0;
    };

    const auto measure = [&] {
        Stage stage(device(), mScene);
        Scores scores;
        const auto truth = stage.render(makeShot("accumulate"));
        Shot shot = makePaperShot("gather");
        shot.aovs = {"motion", "tiles"};
        const auto gather = stage.render(shot);
        const auto hybrid = stage.render(makePaperShot("hybrid"));
        const image::Image& tiles = gather.intermediates.at("tiles");
        scores.speed = measureSpeed(gather.intermediates.at("motion"));
        scores.gather = computeReachedPsnr(gather.color, truth.color, tiles);
        scores.hybrid = computeReachedPsnr(hybrid.color, truth.color, tiles);
        return scores;
    };
    const Scores moving = measure();
    const dvec3 right(scene::worldFromEntity(mScene.world, mScene.camera, GetParam().seconds)[0]);
    // One metre a second first: motion is proportional to it.
    freeze(mScene.world, GetParam().seconds);
    slide(mScene.world, GetParam().seconds, right);
    Shot probe = makeShot("sharp");
    probe.aovs = {"motion"};
    probe.exposureSeconds = 10.0;
    const double perMetre =
        measureSpeed(test::renderOnce(device(), mScene, probe).intermediates.at("motion")) / 10.0;
    ASSERT_GT(perMetre, 0.0);
    const double metresPerSecond = moving.speed / (perMetre * GetParam().exposureSeconds);
    slide(mScene.world, GetParam().seconds, right * metresPerSecond);
    const Scores rigid = measure();
    EXPECT_NEAR(rigid.speed, moving.speed, 0.1 * moving.speed);
    EXPECT_GE(moving.gather, rigid.gather - GetParam().mostLost);
    EXPECT_GE(moving.hybrid, rigid.hybrid - GetParam().mostLost);
}

INSTANTIATE_TEST_SUITE_P(
    OnRealModels,
    MotionSources,
    ::testing::ValuesIn(kModels),
    [](const auto& param) { return std::string(param.param.name); }
);

} // namespace
} // namespace shutter
