// SPDX-License-Identifier: MIT
// The shutter's response, alike in every method, and frames without an exposure.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using scene::ResponseShape;
using scene::ShutterPhase;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class ShutterLaw : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

scene::CameraShutter withResponse(ResponseShape shape, std::vector<double> samples = {}) {
    scene::CameraShutter shutter;
    shutter.response.shape = shape;
    shutter.response.samples = std::move(samples);
    return shutter;
}

/// Most light at open, none at close: it tells early from late.
scene::CameraShutter fallingResponse() {
    return withResponse(ResponseShape::Sampled, {1.0, 0.0});
}

/// A white quad crosses black: pixel x is lit by the light taken between the quad's edges' passing.
void expectEdges(
    gpu::Device& device,
    const scene::CameraShutter& shutter,
    const std::function<double(double)>& lightBefore
) {
    constexpr double kWidth = 20.3;
    constexpr double kMotion = 31.7;
    SceneBuilder scene;
    scene.setPixelView(8);
    scene.add(
        test::makeQuad(kWidth, 20, scene.addColor({1, 1, 1})),
        {.position = {0.4, 0, -10}, .velocity = {kMotion, 0, 0}}
    );
    Stage stage(device, scene);
    for (const auto phase : {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End}) {
        const double left =
            48.4 + kMotion * scene::computeExposure({1.0, phase}, 0.0).open - kWidth / 2.0;
        // Each edge is met to one of the 512 instants, or 256 rays of each set.
        for (const auto& [method, tolerance] :
             {std::pair{"accumulate", 1.0 / 255.0}, {"truth", 2.0 / 256.0}}) {
            const auto result = stage.render(
                {.method = method, .height = 8, .phase = phase, .shutter = shutter, .instants = 512}
            );
            for (uint32_t x = 0; x < 96; ++x) {
                const double enters = std::clamp((x + 0.5 - left - kWidth) / kMotion, 0.0, 1.0);
                const double leaves = std::clamp((x + 0.5 - left) / kMotion, 0.0, 1.0);
                ASSERT_NEAR(
                    result.color.at(x, 4, 1), lightBefore(leaves) - lightBefore(enters), tolerance
                ) << method
                  << " at " << x << " phase " << int(phase);
            }
        }
    }
}

TEST_F(ShutterLaw, AMovingEdgeUnderATriangleIsTheClosedForm) {
    expectEdges(device(), withResponse(ResponseShape::Triangle), [](double s) {
        return s < 0.5 ? 2.0 * s * s : 1.0 - 2.0 * (1.0 - s) * (1.0 - s);
    });
}

TEST_F(ShutterLaw, AMovingEdgeUnderFallingLightIsTheClosedForm) {
    expectEdges(device(), fallingResponse(), [](double s) { return 2.0 * s - s * s; });
}

TEST_F(ShutterLaw, AMovingEdgeUnderATrapezoidIsTheClosedForm) {
    scene::CameraShutter shutter = withResponse(ResponseShape::Trapezoid);
    shutter.response.openShare = 0.2;
    shutter.response.closeShare = 0.4;
    expectEdges(device(), shutter, [](double s) {
        const double opening = std::min(s, 0.2);
        const double closing = std::max(s - 0.6, 0.0);
        return (opening * opening / 0.4 + std::clamp(s - 0.2, 0.0, 0.4) + closing -
                closing * closing / 0.8) /
               0.7;
    });
}

SceneBuilder makeScene() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeQuad(8, 6, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    scene.add(
        test::makeBox({0.8, 0.8, 0.8}, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0.1, 0, -2.5}, .velocity = {0.6, 0.2, 0.3}, .angularVelocity = {0.3, 2, 1}}
    );
    scene.moveCamera({.angularVelocity = {0.02, 0.2, 0.05}});
    return scene;
}

TEST_F(ShutterLaw, RaysAndInstantsAgreeUnderAnyResponse) {
    const SceneBuilder scene = makeScene();
    Stage stage(device(), scene);
    const auto draw = [&](std::string_view method, const scene::CameraShutter& shutter) {
        return stage
            .render(
                {.method = method, .width = 64, .height = 48, .shutter = shutter, .instants = 256}
            )
            .color;
    };
    const auto box = draw("accumulate", {});
    for (const auto& shutter :
         {withResponse(ResponseShape::Triangle),
          fallingResponse(),
          withResponse(ResponseShape::Sampled, {0, 3, 0, 0, 1, 4, 0})}) {
        const auto instants = draw("accumulate", shutter);
        EXPECT_GE(image::computePsnr(draw("truth", shutter), instants), 45.0);
        EXPECT_LT(image::computePsnr(box, instants), 40.0) << "the response shows";
    }
}

TEST_F(ShutterLaw, WhatIsConstantIsABoxBitForBitInEveryMethod) {
    const SceneBuilder scene = makeScene();
    Stage stage(device(), scene);
    for (const std::string_view method : test::listRasterMethods(device())) {
        const auto box = stage.render({.method = method}).color;
        for (const auto& shutter :
             {withResponse(ResponseShape::Trapezoid),
              withResponse(ResponseShape::Sampled, {2, 2, 2})})
            EXPECT_TRUE(
                test::sameBits(box, stage.render({.method = method, .shutter = shutter}).color)
            ) << method;
    }
}

TEST_F(ShutterLaw, InsideAMoverTheFiltersSeeItWhenItsLightIsTaken) {
    // A ramp of 1/400 a pixel that moves 24 px: where a pixel looks on average is what it shows.
    constexpr double kMotion = 24.0;
    SceneBuilder scene;
    scene.setPixelView(64);
    scene::Primitive ramp = test::makeQuad(400, 200, scene.addColor({1, 1, 1}));
    for (const math::vec3& position : ramp.positions)
        ramp.colors.push_back({math::vec3(position.x / 400.0f + 0.5f), 1.0f});
    scene.add(std::move(ramp), {.position = {0, 0, -10}, .velocity = {kMotion, 0, 0}});
    Stage stage(device(), scene);
    const auto meanShiftPx = [&](std::string_view method, const scene::CameraShutter& shutter) {
        const Shot shot{.method = method, .shutter = shutter, .instants = 256};
        const auto blurred = stage.render(shot).color;
        const auto sharp = stage.render({}).color;
        double sum = 0.0;
        for (uint32_t y = 16; y < 48; ++y)
            for (uint32_t x = 32; x < 64; ++x)
                sum += double(blurred.at(x, y, 0)) - double(sharp.at(x, y, 0));
        return sum / (32.0 * 32.0) * 400.0;
    };
    // On average light is taken at s = 1/3: 1/6 of the motion from the middle.
    const double expected = kMotion / 6.0;
    EXPECT_NEAR(meanShiftPx("accumulate", fallingResponse()), expected, 0.1);
    for (const std::string_view method : test::listBlurMethods(device())) {
        EXPECT_NEAR(meanShiftPx(method, {}), 0.0, 0.25) << method;
        const double shift = meanShiftPx(method, fallingResponse());
        // The means of these two are plain ones; the others weigh near taps more (a cone over half
        // the motion gives 5/36 for 1/6), and of Guertin's some go across.
        if (method == "own_velocity" || method == "jimenez2014") {
            EXPECT_NEAR(shift, expected, 0.25) << method;
        }
        EXPECT_GT(shift, 0.6 * expected) << method;
        EXPECT_LT(shift, 1.1 * expected) << method;
    }
}

TEST_F(ShutterLaw, APausedFrameIsSharpBitForBitInEveryMode) {
    const SceneBuilder scene = makeScene();
    Stage stage(device(), scene);
    const auto sharp = stage.render({}).color;
    for (const auto mode :
         {scene::ShutterMode::Physical, scene::ShutterMode::Angle, scene::ShutterMode::Capped}) {
        scene::CameraShutter shutter;
        shutter.mode = mode;
        for (const std::string_view method : test::listRasterMethods(device()))
            EXPECT_TRUE(test::sameBits(
                sharp,
                stage.render({.method = method, .shutter = shutter, .frameSeconds = 0.0}).color
            )) << method;
        const auto skipped =
            stage.render({.method = "gather", .shutter = shutter, .frameSeconds = 0.0});
        EXPECT_EQ(test::describeMotionBlur(skipped), "skipped: the exposure is 0");
    }
}

TEST_F(ShutterLaw, ACappedShutterDrawsAHitchAsAFrameAtTheReferenceRate) {
    const SceneBuilder scene = makeScene();
    Stage stage(device(), scene);
    scene::CameraShutter shutter;
    shutter.mode = scene::ShutterMode::Capped;
    const auto draw = [&](double frameSeconds) {
        return stage.render({.method = "gather", .shutter = shutter, .frameSeconds = frameSeconds})
            .color;
    };
    EXPECT_TRUE(test::sameBits(draw(10.0), draw(1.0 / 24.0)));
    EXPECT_FALSE(test::sameBits(draw(10.0), draw(1.0 / 48.0)));
}

} // namespace
} // namespace shutter
