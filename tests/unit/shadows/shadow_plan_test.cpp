// SPDX-License-Identifier: MIT
// The maps of a frame's shadows, their views, and their stability.
#include "modules/shadows/shadow_plan.h"
#include "modules/shadows/shadow_views.h"
#include "shaders/shadows/shadow_filter.glsl"
#include "tests/unit/extract/extraction_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace shutter::shadows {
namespace {

using math::dvec3;
using math::dvec4;

class ShadowPlanOfScenes : public extract::Extraction {
  protected:
    ShadowPlanOfScenes() {
        settings.mode = ShadowMode::Sharp;
        addSun(glm::angleAxis(-1.2, dvec3(1, 0, 0)));
        addBox(dvec3(0, 0, -9)); // begins 8 metres before the camera
        addBox(dvec3(0, 0, -129));
    }

    void addLight(scene::LightKind kind, const math::Transform& place) {
        const ecs::Entity light = world.registry.create();
        world.registry.add(light, scene::LocalTransform{place});
        world.registry.add(light, scene::Light{.kind = kind});
    }

    void addSun(const math::dquat& turn) {
        addLight(scene::LightKind::Directional, {.rotation = turn});
    }

    void addTurning(const math::Transform& place, const dvec3& radiansPerSecond) {
        world.registry.add(addBox(place), scene::AngularVelocity{radiansPerSecond});
    }

    ShadowPlan plan() {
        const extract::FrameView view(world, request);
        return planShadows({world, layout, request, view, extract()}, settings);
    }

    ShadowSettings settings;

    /// Whether the finest cascade reaches the back of the nearest box.
    bool isNearestInFinest() {
        const ShadowPlan found = plan();
        EXPECT_TRUE(found.shadows.run) << found.shadows.reason;
        EXPECT_GT(found.maps.size(), 1u);
        if (found.maps.empty())
            return false;
        const dvec4 clip = found.maps.front().view.clipFromWorld * dvec4(0, 0, -9.9, 1);
        return std::abs(clip.x) < 1.0 && std::abs(clip.y) < 1.0;
    }
};

TEST_F(ShadowPlanOfScenes, CascadesBeginWhereTheSceneDoes) {
    EXPECT_TRUE(isNearestInFinest());
    // A box that surrounds the camera gives no bound for the distance.
    addBox(math::Transform{.translation = dvec3(0), .scale = dvec3(60.0)});
    EXPECT_TRUE(isNearestInFinest());
    addBox(math::Transform{.translation = dvec3(0, 0, -1.5), .scale = dvec3(0.1)});
    EXPECT_FALSE(isNearestInFinest()) << "the cascades do not begin at what came nearer";
}

TEST_F(ShadowPlanOfScenes, LayersAreAsLargeAsTheirMoversAreSeen) {
    settings.mode = ShadowMode::Blurred;
    settings.mapSize = 2048;
    for (const double distance : {4.0, 60.0})
        world.registry.add(
            addBox(math::Transform{.translation = {0, 0, -distance}, .scale = dvec3(0.5)}),
            scene::LinearVelocity{dvec3(0.2, 0, 0)}
        );
    const auto sizeOf = [&](size_t mover) {
        const ShadowPlan found = plan();
        EXPECT_EQ(found.movers.size(), 2u);
        const uint32_t first = found.lights.at(0).firstLayer;
        return found.maps.at(first + found.movers.at(mover).firstLayer).sizePx;
    };
    // Its sphere's width, 1.7 metres, is 40 pixels at 4 metres.
    EXPECT_EQ(sizeOf(0), 128u);
    EXPECT_EQ(sizeOf(1), 16u);
    settings.mapSize = 256;
    EXPECT_EQ(sizeOf(0), 64u) << "a quarter at most";
}

TEST_F(ShadowPlanOfScenes, AMoverAroundTheCameraHasTheLargestLayer) {
    addMover(dvec3(0, 0, 0), dvec3(0.2, 0, 0));
    const ShadowPlan found = plan();
    ASSERT_EQ(found.movers.size(), 1u);
    EXPECT_EQ(found.maps.back().sizePx, settings.mapSize / 4);
}

TEST_F(ShadowPlanOfScenes, FlatMoversHaveFewerLayersThanACube) {
    settings.mode = ShadowMode::Blurred;
    for (const dvec3 scale : {dvec3(1.0), dvec3(0.9, 0.9, 0.1)})
        addTurning({.translation = {0, 0, -9}, .scale = scale}, {0, 0, 0.9});
    const ShadowPlan found = plan();
    ASSERT_EQ(found.movers.size(), 2u);
    EXPECT_LT(found.movers[1].partCount, found.movers[0].partCount);
}

TEST_F(ShadowPlanOfScenes, RunsAreAsShortAsAnyLightRequires) {
    settings.mode = ShadowMode::Blurred;
    settings.mapSize = 4096;
    addTurning({.translation = {2, 0, -40}, .scale = {1.0, 1.0, 0.1}}, {0, 0, 0.8});
    addBox(dvec3(0, -3, 0)); // the scene reaches to the camera
    const auto runInstants = [&] { return plan().movers.at(0).runInstants; };
    const uint32_t alone = runInstants();
    // A light that takes the shadow to the camera, and needs a large layer.
    addSun(glm::quatLookAt(glm::normalize(dvec3(-0.05, -0.01, 1.0)), dvec3(1, 0, 0)));
    const uint32_t both = runInstants();
    EXPECT_LT(both, alone);
    addSun(glm::quatLookAt(dvec3(0, -1, 0), dvec3(1, 0, 0)));
    EXPECT_EQ(runInstants(), both);
}

TEST_F(ShadowPlanOfScenes, MoversHaveRunsBeforeEachLightThatIsFarAway) {
    settings.mode = ShadowMode::Blurred;
    settings.instants = 10;
    addLight(scene::LightKind::Point, {.translation = {0, 30, 0}});
    addSun(glm::angleAxis(-0.7, dvec3(1, 0, 0))); // the moon
    addTurning({.translation = {2, 0, -9}}, {0, 1.0, 0});
    addMover({-2, 0, -12}, {1, 0, 0});
    const ShadowPlan found = plan();
    ASSERT_EQ(found.movers.size(), 2u);
    EXPECT_LT(found.movers[0].runInstants, found.movers[1].runInstants);
    EXPECT_EQ(found.movers[1].runInstants, shader::kMaxRunInstants);
    EXPECT_EQ(found.movers[1].firstRun, 1u + 12u / found.movers[0].runInstants);
    uint32_t far = 0;
    for (const shader::ShadowLight& light : found.lights)
        if (light.firstRun != shader::kNoShadowRun) {
            EXPECT_EQ(light.firstRun, far++ * found.runs.size() / 2);
        }
    EXPECT_EQ(far, 2u) << "the lamp has no runs, sun and moon have";
    EXPECT_EQ(found.runs.size(), 2 * (found.movers[1].firstRun + 1u + 3u));
}

constexpr uint32_t kSize = 512;
const dvec3 kToSun = glm::normalize(dvec3(0.4, 1.0, 0.3));

math::Bounds makeBox(double half) {
    math::Bounds box;
    box.add(dvec3(-half, -0.1 * half, -half));
    box.add(dvec3(half, 0.3 * half, half));
    return box;
}

CameraSlice makeCamera(const dvec3& eye = {0.0, 1.0, 0.0}) {
    return {eye, glm::normalize(dvec3(0.1, -0.1, -1.0)), 0.7, true, 0.05};
}

bool isInside(const LightView& view, const dvec3& point) {
    const dvec4 clip = view.clipFromWorld * dvec4(point, 1.0);
    return clip.w > 0.0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
}

TEST(ShadowViews, ASlicesSphereHoldsItsCornersAndIsNoLargerThanNeeded) {
    for (const auto& [from, to] : {std::pair{0.1, 1.0}, {1.0, 1.2}, {5.0, 80.0}}) {
        const CameraSlice camera{{1, 2, 3}, {0, 0, -1}, 0.8, true, 0.05};
        const Sphere sphere = boundSlice(camera, from, to);
        double reach = 0.0;
        for (const double at : {from, to})
            for (const double side : {-1.0, 1.0})
                reach = std::max(
                    reach,
                    glm::length(
                        camera.eye + dvec3(side * at * camera.cornerReach, 0.0, -at) - sphere.centre
                    )
                );
        EXPECT_NEAR(reach, sphere.radius, 1e-9 * to);
    }
}

TEST(ShadowViews, CascadesGrowAndTheLastHasTheWholeScene) {
    const auto views = fitCascades(makeCamera(), kToSun, makeBox(20.0), 40.0, kSize);
    ASSERT_GE(views.size(), 2u);
    ASSERT_LE(views.size(), size_t{kMaxCascades});
    for (size_t i = 1; i < views.size(); ++i)
        EXPECT_GT(views[i].texelMetres, views[i - 1].texelMetres);
    for (const double x : {-20.0, 20.0})
        for (const double z : {-20.0, 20.0})
            EXPECT_TRUE(isInside(views.back(), {x, 0.0, z})) << x << ", " << z;
}

TEST(ShadowViews, EachCascadeReachesTheSameNumberOfTimesAsFarAsTheOneBefore) {
    CameraSlice camera = makeCamera();
    camera.near = 4.0;
    const auto views = fitCascades(camera, kToSun, makeBox(5000.0), 1024.0, kSize);
    ASSERT_EQ(views.size(), size_t{kMaxCascades});
    // Four times, give or take the rounding of their widths to quarters of a power of two.
    for (size_t i = 1; i < views.size(); ++i)
        EXPECT_NEAR(std::log2(views[i].texelMetres / views[i - 1].texelMetres), 2.0, 0.26) << i;
}

TEST(ShadowViews, ACascadeStaysWhileTheCameraMovesALittleAndThenMovesByWholeTexels) {
    const math::Bounds scene = makeBox(500.0);
    const auto before = fitCascades(makeCamera(), kToSun, scene, 1000.0, kSize);
    size_t stayed = 0;
    for (int step = 1; step <= 40; ++step) {
        const auto after =
            fitCascades(makeCamera({0.01 * step, 1.0, 0.02 * step}), kToSun, scene, 1000.0, kSize);
        ASSERT_EQ(after.size(), before.size());
        for (size_t i = 0; i < after.size(); ++i) {
            ASSERT_EQ(after[i].texelMetres, before[i].texelMetres);
            stayed += after[i].clipFromWorld == before[i].clipFromWorld;
            const dvec4 shift = after[i].clipFromWorld[3] - before[i].clipFromWorld[3];
            for (const double clip : {shift.x, shift.y}) {
                const double texels = clip * 0.5 * kSize;
                EXPECT_NEAR(texels, std::round(texels), 1e-6);
            }
        }
    }
    EXPECT_GT(stayed, 40u * before.size() * 3 / 4);
}

/// Sizes of the cascades of a scene of this scale.
std::vector<double> listTexels(const CameraSlice& camera, double scale = 1.0) {
    std::vector<double> metres;
    const math::Bounds scene = makeBox(500.0 * scale);
    for (const LightView& view : fitCascades(camera, kToSun, scene, 1000.0 * scale, kSize))
        metres.push_back(view.texelMetres);
    return metres;
}

TEST(ShadowViews, CascadesFollowTheScalesOfScenesAndNotTheTurnsOfTheCamera) {
    CameraSlice camera = makeCamera();
    const std::vector<double> before = listTexels(camera);
    camera.forward = glm::normalize(dvec3(0.9, 0.2, 0.4));
    EXPECT_EQ(listTexels(camera), before);
    // Scales near a centimetre and a kilometre that are powers of two, so that nothing else
    // differs.
    for (const double scale : {1.0 / 128.0, 1024.0}) {
        camera = makeCamera();
        camera.eye *= scale;
        camera.near *= scale;
        const std::vector<double> after = listTexels(camera, scale);
        ASSERT_EQ(after.size(), before.size());
        for (size_t i = 0; i < after.size(); ++i)
            EXPECT_NEAR(after[i] / scale, before[i], 1e-9);
    }
}

TEST(ShadowViews, EachDirectionIsInTheMiddleOfItsFaceOfACube) {
    const dvec3 light(3.0, -1.0, 2.0);
    const auto faces = fitCube(light, 0.01, kSize);
    for (int i = 0; i < 500; ++i) {
        const dvec3 direction(std::sin(i * 1.3), std::cos(i * 2.1), std::sin(i * 0.7 + 1.0));
        const dvec3 point = light + 5.0 * direction;
        const LightView& face = faces.at(shader::cubeFace(math::vec3(direction)));
        const auto place = shader::placeInMap(
            math::vec4(face.clipFromWorld * dvec4(point, 1.0)), math::vec2(0.0f), kSize
        );
        EXPECT_TRUE(place.isCovered) << i;
    }
}

TEST(ShadowViews, ALayerHoldsItsSphere) {
    const Sphere mover{{4.0, 1.0, -3.0}, 0.7};
    const dvec3 light(0.0, 6.0, 0.0);
    ASSERT_TRUE(fitsPointLayer(light, mover));
    EXPECT_FALSE(fitsPointLayer(mover.centre + dvec3(0.9, 0.0, 0.0), mover));
    for (const LightView& view : {fitLayer(kToSun, mover, 128), fitPointLayer(light, mover, 128)})
        for (int i = 0; i < 200; ++i) {
            const dvec3 way =
                glm::normalize(dvec3(std::sin(i * 1.3), std::cos(i * 2.1), std::sin(i * 0.7)));
            const dvec3 point = mover.centre + mover.radius * way;
            EXPECT_TRUE(isInside(view, point)) << i;
            const dvec4 clip = view.clipFromWorld * dvec4(point, 1.0);
            EXPECT_GT(clip.z / clip.w, 0.0);
            EXPECT_LE(clip.z / clip.w, 1.0);
        }
}

TEST(ShadowViews, ASpotsMapHoldsItsCone) {
    const dvec3 direction = glm::normalize(dvec3(0.2, -1.0, 0.1));
    const LightView view = fitSpot({0, 4, 0}, direction, 0.6, 0.01, kSize);
    const dvec3 side = glm::normalize(glm::cross(direction, dvec3(1, 0, 0)));
    for (int i = 0; i < 64; ++i) {
        const dvec3 turned =
            side * std::cos(i * 0.1) + glm::cross(direction, side) * std::sin(i * 0.1);
        const dvec3 point =
            dvec3(0, 4, 0) + 3.0 * (direction * std::cos(0.59) + turned * std::sin(0.59));
        EXPECT_TRUE(isInside(view, point)) << i;
    }
}

} // namespace
} // namespace shutter::shadows
