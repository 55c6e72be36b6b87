// SPDX-License-Identifier: MIT
// What has no past is sharp, in every method alike, from when it is there on.
#include "engine/scene/history.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace shutter {
namespace {

using test::SceneBuilder;
using test::Stage;

class HistoryLaw : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }

    /// Frames of 0.1 s at t = 1, exposed from 0.96 to 1.04 s.
    static image::Image draw(Stage& stage, std::string_view method, double frameSeconds = 0.1) {
        return stage
            .render(
                {.method = method,
                 .seconds = 1.0,
                 .exposureSeconds = 0.08,
                 .frameSeconds = frameSeconds}
            )
            .color;
    }

    /// With frames of no duration there is no exposure: the sharp picture of the same method.
    static void expectSharp(Stage& stage, const std::string& what, bool sharp) {
        for (const std::string_view method : test::listRasterMethods(device()))
            if (method != "sharp") {
                EXPECT_EQ(test::sameBits(draw(stage, method), draw(stage, method, 0.0)), sharp)
                    << what << ", " << method;
            }
        EXPECT_EQ(test::sameBits(draw(stage, "truth"), draw(stage, "truth", 0.0)), sharp)
            << what << ", truth";
    }

    /// In every method that blurs, a share of one picture and the rest of another. `truth` draws a
    /// jump out over 1/1024 of the exposure: one of a pixel's 16 rays may be on its other side.
    static void
    expectMean(Stage& stage, const image::Image& one, double share, const image::Image& other) {
        std::vector<std::string_view> methods = test::listBlurMethods(device());
        methods.insert(methods.end(), {"accumulate", "truth"});
        for (const std::string_view method : methods) {
            const image::Image picture = draw(stage, method);
            const double rays = method == "truth" ? 1.0 / 16.0 : 0.0;
            double most = 0.0;
            for (size_t i = 0; i < picture.pixels.size(); ++i) {
                const double expected = std::lerp(other.pixels[i], one.pixels[i], share);
                const double off = std::abs(double{picture.pixels[i]} - expected);
                const double jump = std::abs(double{one.pixels[i]} - other.pixels[i]);
                most = std::max(most, off - rays * jump);
            }
            EXPECT_LT(most, 0.01) << method;
        }
    }
};

struct Scene {
    SceneBuilder builder;
    ecs::Entity parent;
    ecs::Entity mover;

    explicit Scene(const math::dvec3& cameraTurn) {
        builder.setPerspective(0.9);
        builder.add(
            test::makeQuad(9, 7, builder.addTextured(builder.addWaveTexture())),
            {.position = {0, 0, -5}}
        );
        parent = builder.world.registry.create();
        mover = builder.add(
            test::makeBox({0.8, 0.8, 0.8}, builder.addColor({0.9f, 0.2f, 0.1f})),
            {.position = {-2.5, 0, -2.5}, .velocity = {2.5, 0.2, 0}}
        );
        builder.world.registry.add(mover, scene::Parent{parent});
        builder.moveCamera({.angularVelocity = cameraTurn});
    }
};

TEST_F(HistoryLaw, WhatAppearedOrWasTeleportedIsSharpForThatFrame) {
    const std::vector<std::pair<std::string, std::function<void(Scene&)>>> events = {
        {"appeared", [](Scene& s) { scene::appear(s.builder.world, s.mover, 0.95); }},
        {"appeared before the shutter opened",
         [](Scene& s) { scene::appear(s.builder.world, s.mover, 0.91); }},
        {"its parent was teleported",
         [](Scene& s) { scene::teleport(s.builder.world, s.parent, {}, 1.0); }},
        {"shown",
         [](Scene& s) {
             scene::hide(s.builder.world, s.mover);
             scene::show(s.builder.world, s.mover, 0.955);
         }},
    };
    for (const auto& [name, happen] : events) {
        Scene scene({0, 0, 0});
        Stage stage(device(), scene.builder);
        expectSharp(stage, "before " + name, false);
        happen(scene);
        expectSharp(stage, name, true);
    }
}

TEST_F(HistoryLaw, WhatAppearsDuringTheExposureStandsInItsPlaceFromThenOn) {
    Scene scene({0, 0, 0});
    Stage stage(device(), scene.builder);
    const image::Image there = draw(stage, "sharp");
    scene::hide(scene.builder.world, scene.mover);
    const image::Image without = draw(stage, "sharp");
    scene::show(scene.builder.world, scene.mover, 0.98);
    expectMean(stage, without, 0.25, there);
    EXPECT_TRUE(test::sameBits(draw(stage, "sharp"), there)) << "at the raster instant it is there";
    scene::appear(scene.builder.world, scene.mover, 1.04);
    expectMean(stage, there, 1.0, without);
}

TEST_F(HistoryLaw, WhatIsHiddenDuringTheExposureIsThereUntilThen) {
    Scene scene({0, 0, 0});
    scene.builder.world.registry.remove<scene::LinearVelocity>(scene.mover);
    scene.builder.world.registry.get<scene::LocalTransform>(scene.mover).transform.translation.x =
        0.0;
    Stage stage(device(), scene.builder);
    const image::Image there = draw(stage, "sharp");
    scene::hide(scene.builder.world, scene.mover);
    const image::Image without = draw(stage, "sharp");
    scene::hide(scene.builder.world, scene.mover, 0.98);
    expectMean(stage, there, 0.25, without);
    EXPECT_TRUE(test::sameBits(draw(stage, "sharp"), without)) << "at the raster instant it is not";
    scene::hide(scene.builder.world, scene.mover, 1.04);
    expectMean(stage, there, 1.0, without);
    scene::hide(scene.builder.world, scene.mover, 0.96);
    expectMean(stage, there, 0.0, without);
}

TEST_F(HistoryLaw, ACutIsSharpForThatFrameEverywhere) {
    const std::vector<std::pair<std::string, std::function<void(Scene&)>>> events = {
        {"cut", [](Scene& s) { scene::cut(s.builder.world, s.builder.camera, 0.95); }},
        {"the world began", [](Scene& s) { s.builder.world.startSeconds = 1.0; }},
    };
    for (const auto& [name, happen] : events) {
        Scene scene({0, 0.3, 0});
        Stage stage(device(), scene.builder);
        expectSharp(stage, "before " + name, false);
        happen(scene);
        expectSharp(stage, name, true);
    }
}

TEST_F(HistoryLaw, WhatAppearsUnderAMovingCameraKeepsTheCamerasBlur) {
    Scene scene({0, 0.3, 0});
    Stage stage(device(), scene.builder);
    scene::appear(scene.builder.world, scene.mover, 0.95);
    const auto appeared = draw(stage, "accumulate");
    // The same picture as of a mover that never moved.
    const math::dmat4 place = scene::worldFromEntity(scene.builder.world, scene.mover, 1.0);
    scene.builder.world.registry.remove<scene::LinearVelocity>(scene.mover);
    scene.builder.world.registry.get<scene::LocalTransform>(scene.mover).transform.translation =
        math::dvec3(place[3]);
    EXPECT_TRUE(test::sameBits(appeared, draw(stage, "accumulate")));
    expectSharp(stage, "the camera moves", false);
}

TEST_F(HistoryLaw, WhatWasDespawnedOrIsHiddenWasNeverThere) {
    const auto add = [](SceneBuilder& builder) {
        return builder.add(
            test::makeBox({0.8, 0.8, 0.8}, 1), {.position = {-1, 0, -2}, .velocity = {1, 0.2, 0}}
        );
    };
    Scene never({0, 0.1, 0});
    Stage without(device(), never.builder);
    for (const bool despawns : {false, true}) {
        Scene scene({0, 0.1, 0});
        const ecs::Entity gone = add(scene.builder);
        Stage stage(device(), scene.builder);
        EXPECT_FALSE(test::sameBits(draw(stage, "gather"), draw(without, "gather")));
        if (despawns)
            scene::despawn(scene.builder.world, gone);
        else
            scene::hide(scene.builder.world, gone);
        for (const std::string_view method : test::listRasterMethods(device()))
            EXPECT_TRUE(test::sameBits(draw(stage, method), draw(without, method)))
                << method << despawns;
        EXPECT_TRUE(test::sameBits(draw(stage, "truth"), draw(without, "truth")));
    }
}

} // namespace
} // namespace shutter
