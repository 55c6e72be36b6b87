// SPDX-License-Identifier: MIT
// What shadow maps see, and that they keep still.
#include "engine/extract/shadow_views.h"
#include "shaders/render/shadow_filter.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::extract {

namespace {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;

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

} // namespace

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

TEST(ShadowViews, TurningTheCameraLeavesCascadesTheirSize) {
    CameraSlice camera = makeCamera();
    const auto before = fitCascades(camera, kToSun, makeBox(500.0), 1000.0, kSize);
    camera.forward = glm::normalize(dvec3(0.9, 0.2, 0.4));
    const auto after = fitCascades(camera, kToSun, makeBox(500.0), 1000.0, kSize);
    ASSERT_EQ(after.size(), before.size());
    for (size_t i = 0; i < after.size(); ++i)
        EXPECT_EQ(after[i].texelMetres, before[i].texelMetres);
}

TEST(ShadowViews, CascadesFollowTheScalesOfScenes) {
    // Scales near a centimetre and a kilometre that are powers of two, so that nothing else
    // differs.
    for (const double scale : {1.0 / 128.0, 1024.0}) {
        CameraSlice camera = makeCamera();
        const auto before = fitCascades(camera, kToSun, makeBox(16.0), 32.0, kSize);
        camera.eye *= scale;
        camera.near *= scale;
        const auto after = fitCascades(camera, kToSun, makeBox(16.0 * scale), 32.0 * scale, kSize);
        ASSERT_EQ(after.size(), before.size());
        for (size_t i = 0; i < after.size(); ++i)
            EXPECT_NEAR(after[i].texelMetres / scale, before[i].texelMetres, 1e-9);
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

} // namespace shutter::extract
