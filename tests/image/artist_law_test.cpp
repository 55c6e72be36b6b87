// SPDX-License-Identifier: MIT
// The artist's scales mean the same in the raster image, for rays, and for truth.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"
#include "tests/support/white_quads.h"

#include <functional>
#include <string>
#include <vector>

namespace shutter {
namespace {

using test::SceneBuilder;
using test::Stage;

/// One control turned: on the camera's shutter, or on the mover.
struct Control {
    std::string name;
    scene::CameraShutter shutter{};
    scene::MotionBlur mover{};
};

std::vector<Control> listControls() {
    std::vector<Control> controls;
    const auto add = [&](const char* name, const std::function<void(Control&)>& turn) {
        controls.push_back({name});
        turn(controls.back());
    };
    add("camera rotation 0", [](Control& c) { c.shutter.cameraRotationScale = 0.0; });
    add("camera rotation 2", [](Control& c) { c.shutter.cameraRotationScale = 2.0; });
    add("camera translation 0", [](Control& c) { c.shutter.cameraTranslationScale = 0.0; });
    add("objects 0", [](Control& c) { c.shutter.objectScale = 0.0; });
    add("objects 1.5", [](Control& c) { c.shutter.objectScale = 1.5; });
    add("mover 0.5", [](Control& c) { c.mover.scale = 0.5; });
    add("mover 2", [](Control& c) { c.mover.scale = 2.0; });
    add("mover excluded", [](Control& c) { c.mover.exclude = true; });
    add("cap of 6 percent", [](Control& c) { c.shutter.maxBlurPercent = 6.0; });
    add("all", [](Control& c) {
        c.shutter.cameraRotationScale = 0.5;
        c.shutter.cameraTranslationScale = 1.5;
        c.shutter.objectScale = 0.7;
        c.mover.scale = 1.3;
    });
    return controls;
}

class ArtistLaw : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

/// A camera that pans and goes sideways, a textured wall, a mover.
struct Scene {
    SceneBuilder builder;
    ecs::Entity mover;

    Scene() {
        builder.setPerspective(0.9);
        builder.add(
            test::makeQuad(9, 7, builder.addTextured(builder.addWaveTexture())),
            {.position = {0, 0, -5}}
        );
        mover = builder.add(
            test::makeQuad(1.4, 1.4, builder.addColor({0.9f, 0.2f, 0.1f})),
            {.position = {0.1, 0, -2.5}, .velocity = {0.5, 0.2, 0.2}}
        );
        builder.moveCamera({.velocity = {-0.3, 0.1, 0.1}, .angularVelocity = {0.02, 0.2, 0.1}});
    }
};

TEST_F(ArtistLaw, RaysAndInstantsAgreeUnderEveryControl) {
    Scene scene;
    Stage stage(device(), scene.builder);
    const auto draw = [&](std::string_view method, const scene::CameraShutter& shutter) {
        return stage
            .render(
                {.method = method, .width = 64, .height = 48, .shutter = shutter, .instants = 256}
            )
            .color;
    };
    const auto plain = draw("accumulate", {});
    for (const Control& control : listControls()) {
        scene.builder.world.registry.add(scene.mover, control.mover);
        const auto instants = draw("accumulate", control.shutter);
        EXPECT_GE(image::computePsnr(draw("truth", control.shutter), instants), 45.0)
            << control.name;
        EXPECT_LT(image::computePsnr(plain, instants), 45.0) << control.name << " shows";
    }
}

TEST_F(ArtistLaw, MotionVectorsAreTheDisplacementInThePicture) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const ecs::Entity marker =
        test::addMarker(scene, 0.25, {.position = {0.2, 0.1, -3}, .velocity = {0.6, 0.3, 0.4}});
    scene.moveCamera({.velocity = {-0.3, 0.1, 0.1}, .angularVelocity = {0.02, 0.2, 0.1}});
    Stage stage(device(), scene);
    for (const Control& control : listControls()) {
        SCOPED_TRACE(control.name);
        scene.world.registry.add(marker, control.mover);
        test::expectMotionOfMarker(
            stage,
            {.exposureSeconds = 0.4, .shutter = control.shutter},
            control.mover.exclude ? 0.0 : 1.0
        );
    }
}

TEST_F(ArtistLaw, InsideAnExcludedMoverEveryMethodIsSharp) {
    Scene scene;
    // A texture shows whatever is off its place.
    const ecs::Entity excluded = scene.builder.add(
        test::makeQuad(1.2, 1.2, scene.builder.addTextured(scene.builder.addWaveTexture())),
        {.position = {-0.1, 0.1, -2}, .velocity = {0.8, 0.1, 0.1}, .angularVelocity = {0, 0.5, 2}}
    );
    scene.builder.world.registry.add(excluded, scene::MotionBlur{.exclude = true});
    Stage stage(device(), scene.builder);
    const auto sharp = stage.render({.aovs = {"mesh_id"}});
    const image::Image& ids = sharp.intermediates.at("mesh_id");
    const float id = ids.at(48, 32, 0);
    const auto isInside = [&](uint32_t x, uint32_t y) {
        if (x == 0 || y == 0)
            return false;
        for (uint32_t row = y - 1; row <= y + 1; ++row)
            for (uint32_t column = x - 1; column <= x + 1; ++column)
                if (row >= 64 || column >= 96 || ids.at(column, row, 0) != id)
                    return false;
        return true;
    };
    const auto isElsewhere = [&](uint32_t x, uint32_t y) { return ids.at(x, y, 0) != id; };
    size_t inside = 0;
    for (uint32_t y = 1; y < 63; ++y)
        for (uint32_t x = 1; x < 95; ++x)
            inside += isInside(x, y);
    ASSERT_GT(inside, 300u);
    const auto expectSharpInside = [&](std::string_view method, uint32_t filterLevels = 5) {
        test::Shot shot{.method = method, .instants = 32};
        shot.settings.filterLevels = filterLevels;
        const auto blurred = stage.render(shot).color;
        // A step of the half floats, and what a texel's filter makes of places 1e-4 px apart;
        // Jimenez's filter fades still pixels over one tap's distance wherever motion reaches.
        // The filter of denoised takes texture for noise in each tile that motion crosses: 0.111
        // was measured. Its rays alone are held to the others' bound below.
        const double tolerance = method == "jimenez2014"                    ? 0.03
                                 : method == "denoised" && filterLevels > 0 ? 0.15
                                                                            : 4e-3;
        EXPECT_LT(test::computeMaxDifferenceWhere(blurred, sharp.color, isInside), tolerance)
            << method;
        EXPECT_GT(test::computeMaxDifferenceWhere(blurred, sharp.color, isElsewhere), 0.1)
            << method;
    };
    for (const std::string_view method : test::listBlurMethods(device()))
        expectSharpInside(method);
    expectSharpInside("denoised", 0);
    expectSharpInside("accumulate");
    expectSharpInside("truth");
}

TEST_F(ArtistLaw, WithEveryScaleZeroThePictureIsSharpBitForBit) {
    Scene scene;
    Stage stage(device(), scene.builder);
    scene::CameraShutter shutter;
    shutter.cameraRotationScale = shutter.cameraTranslationScale = shutter.objectScale = 0.0;
    const auto sharp = stage.render({}).color;
    for (const std::string_view method : test::listRasterMethods(device()))
        EXPECT_TRUE(
            test::sameBits(sharp, stage.render({.method = method, .shutter = shutter}).color)
        ) << method;
    const auto skipped = stage.render({.method = "hybrid", .shutter = shutter});
    EXPECT_TRUE(test::describeMotionBlur(skipped).starts_with("skipped: nothing"));
}

} // namespace
} // namespace shutter
