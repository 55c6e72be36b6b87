// SPDX-License-Identifier: MIT
// The motion blur on raw handles: what a host gets is what the plugin gives, bit for bit.
#include "engine/graph/execute.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/gpu/embedding_host.h"
#include "tests/gpu/gbuffer_host.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <array>
#include <span>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::getMethod;
using motion_blur::HostDevice;
using motion_blur::Method;
using motion_blur::MotionBlurSettings;
using test::gather;
using test::HostFrame;
using test::HostOfTheGBuffer;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;

/// Two movers that cross before a wall, one of them near.
void build(test::SceneBuilder& scene) {
    scene.setPerspective(1.0);
    const auto wall = scene.addTextured(scene.addWaveTexture());
    const auto front = scene.addTextured(scene.addWaveTexture(32));
    scene.add(test::makeQuad(12.0, 8.0, wall), {.position = dvec3(0.0, 0.0, -6.0)});
    scene.add(
        test::makeQuad(1.2, 1.2, front),
        {.position = dvec3(0.2, 0.1, -3.0), .velocity = dvec3(1.0, 0.2, 0.0)}
    );
    scene.add(
        test::makeBox(dvec3(0.8), front),
        {.position = dvec3(-1.0, -0.4, -4.0), .angularVelocity = dvec3(0.0, 0.0, 1.0)}
    );
}

class EmbeddedPictures : public test::EmbeddedTest {
  protected:
    /// Draws a frame with the host's blur before the plugin's, which must be the same.
    /// Without rays, the C interface draws the same, too.
    static void expectSameAsPlugin(
        HostDevice host,
        std::span<const Method* const> methods,
        scene::ResponseShape shape = scene::ResponseShape::Triangle
    ) {
        test::SceneBuilder scene;
        build(scene);
        render::Renderer renderer(device(), scene.world.assets);
        if (host.rayTier != gpu::RayTier::None)
            host.sceneLayout = renderer.scene().textureLayout();
        const auto blur = create(host);
        ASSERT_TRUE(blur);
        render::FrameRequest request;
        request.view.camera = scene.camera;
        scene::CameraShutter shutter;
        shutter.exposureSeconds = 0.5;
        shutter.response.shape = shape;
        const test::BlurOfC c(device());
        request.view.exposure = scene::computeExposure(shutter, 0.0, scene::kStillFrameSeconds);
        request.view.width = kWidth;
        request.view.height = kHeight;
        const auto sharp = renderer.renderFrame(scene.world, request, {});
        ASSERT_TRUE(sharp.ok()) << sharp.error().message;
        request.intermediates = {"mask"};
        for (const Method* method : methods) {
            SCOPED_TRACE(method->name);
            MotionBlurSettings settings;
            settings.method = method;
            HostOfTheGBuffer foreign(device(), *blur, settings, {kWidth, kHeight});
            if (method->rays == motion_blur::RayNeed::None)
                foreign.blurOfC = c.blur;
            if (shape == scene::ResponseShape::Triangle)
                foreign.responseForC = test::triangleResponse();
            motion_blur::MotionBlurPlugin plugin(device(), renderer.scene(), settings);
            const std::array<render::PostEffect*, 2> effects{&foreign, &plugin};
            const auto drawn = renderer.renderFrame(scene.world, request, effects);
            ASSERT_TRUE(drawn.ok()) << drawn.error().message;
            const image::Image& expected = drawn.value().color;
            EXPECT_FALSE(test::sameBits(expected, sharp.value().color)) << "nothing was blurred";
            EXPECT_TRUE(test::sameBits(foreign.output.read(), expected));
            EXPECT_TRUE(test::sameBits(foreign.inPlace.read(), expected));
            if (foreign.blurOfC) {
                EXPECT_TRUE(test::sameBits(foreign.byC.read(), expected));
            }
            if (method == &getMethod("hybrid")) {
                EXPECT_GT(test::countSet(drawn.value().intermediates.at("mask")), 50u);
            }
        }
    }
};

TEST_F(EmbeddedPictures, EachMethodWithoutRaysGivesTheBitsOfThePlugin) {
    std::vector<const Method*> methods;
    for (const Method* method : motion_blur::listMethods())
        if (method->readsImagesOnly())
            methods.push_back(method);
    expectSameAsPlugin(describeHost(), methods);
}

TEST_F(EmbeddedPictures, ThePluginAndBothInterfacesGiveTheSameBits) {
    const std::array methods{&getMethod("gather"), &getMethod("guertin2014")};
    for (const auto shape : {scene::ResponseShape::Box, scene::ResponseShape::Triangle})
        expectSameAsPlugin(describeHost(), methods, shape);
}

TEST_F(EmbeddedPictures, HybridGivesTheBitsOfThePlugin) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    HostDevice host = describeHost();
    host.rayTier = device().info().rayTier;
    expectSameAsPlugin(host, std::array{&getMethod("hybrid")});
}

// Validation finds whatever is destroyed or overwritten while a frame is in flight.
TEST_F(EmbeddedPictures, FramesInFlightMayChangeTheirSize) {
    const auto blur = create(describeHost());
    ASSERT_TRUE(blur);
    std::array<gpu::Frame, 2> frames{gpu::Frame(device()), gpu::Frame(device())};
    gpu::LivingObjects small;
    gpu::LivingObjects last;
    for (uint32_t i = 0; i < 12; ++i) {
        const bool isLarge = i >= 4 && i < 8;
        const HostFrame host(device(), isLarge ? 120 : 40, isLarge ? 72 : 24);
        gpu::Frame& frame = frames[i % 2];
        frame.begin(); // waits for the one before the last
        host.recordClears(frame.commands());
        const core::Status done = blur->record(frame.commands(), i % 2, host.inputs(), gather());
        ASSERT_TRUE(done.ok()) << done.error().message;
        frame.submit();
        (i < 4 ? small : last) = blur->living();
    }
    for (gpu::Frame& frame : frames)
        frame.wait();
    EXPECT_GT(small.images, 0u);
    EXPECT_EQ(last, small) << "what the large pictures needed is gone";
}

TEST_F(EmbeddedPictures, WhatResizingLeftOverGoesWhenItsFramesAreDone) {
    HostDevice description = describeHost();
    description.framesInFlight = 3;
    const auto blur = create(description);
    ASSERT_TRUE(blur);
    gpu::Frame frame(device());
    const auto draw = [&](uint32_t slot, uint32_t size) {
        const HostFrame host(device(), size, size);
        frame.begin();
        host.recordClears(frame.commands());
        EXPECT_TRUE(blur->record(frame.commands(), slot, host.inputs(), gather()).ok());
        frame.submit();
        frame.wait();
    };
    draw(0, 40);
    const gpu::LivingObjects one = blur->living();
    draw(1, 40); // not said to be done until below
    draw(0, 80);
    draw(0, 40);
    draw(0, 40);
    EXPECT_GT(blur->living().images, 2 * one.images) << "frame 1 may still use what was retired";
    EXPECT_TRUE(blur->markDone(1).ok());
    draw(0, 40);
    EXPECT_LE(blur->living().images, 2 * one.images);
}

} // namespace
} // namespace shutter
