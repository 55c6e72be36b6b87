// SPDX-License-Identifier: MIT
// What a host hands in wrongly is refused by one sentence that names it.
#include "engine/gpu/frame.h"
#include "engine/math/transform.h"
#include "engine/render/renderer.h"
#include "tests/gpu/embedding_host.h"
#include "tests/kit/scene_builder.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shutter {
namespace {

using motion_blur::EmbeddedMotionBlur;
using motion_blur::getMethod;
using motion_blur::HostDevice;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using test::gather;
using test::HostFrame;
using test::kSampled;
using test::makeImage;

void expectRefusal(const core::Status& status, const std::string& part) {
    ASSERT_FALSE(status.ok()) << "expected: " << part;
    EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
}

class EmbeddedRefusals : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        mBlur = create(describeHost());
        mHost.emplace(device(), 40, 24);
        mFrame.emplace(device());
        inputs = mHost->inputs();
        settings = gather();
    }

    void TearDown() override {
        mFrame.reset();
        mHost.reset();
        mBlur.reset();
        EmbeddedTest::TearDown();
    }

    core::Status record(uint32_t frame = 0) {
        mFrame->begin();
        mHost->recordClears(mFrame->commands());
        const core::Status status = mBlur->record(mFrame->commands(), frame, inputs, settings);
        mFrame->submit();
        mFrame->wait();
        return status;
    }

    HostInputs inputs;
    MotionBlurSettings settings;
    std::unique_ptr<EmbeddedMotionBlur> mBlur;
    std::optional<HostFrame> mHost;
    std::optional<gpu::Frame> mFrame;
};

TEST_F(EmbeddedRefusals, EachBadInputIsNamed) {
    const HostInputs good = inputs;
    ASSERT_TRUE(record().ok());
    expectRefusal(record(2), "frame is 2, framesInFlight 2");
    expectRefusal(mBlur->record(VK_NULL_HANDLE, 0, inputs, settings), "command buffer is null");
    const auto refuse = [&](auto&& change, const std::string& part) {
        inputs = good;
        change();
        expectRefusal(record(), part);
    };
    refuse([&] { inputs.width = 0; }, "the size is 0 x 24");
    refuse([&] { inputs.height = 32769; }, "the size is 40 x 32769");
    const uint32_t most = device().limits().maxImageDimension2D;
    if (most < 32768) {
        refuse([&] { inputs.width = most + 1; }, "the device's maxImageDimension2D");
        refuse(
            [&] {
                inputs.color.extent = {most + 1, 24};
                inputs.color.area.extent = {40, 24};
            },
            "color is said to be " + std::to_string(most + 1) + " x 24"
        );
    }
    refuse([&] { inputs.width = 400; }, "color takes ");
    refuse([&] { inputs.rasterTime = -0.1; }, "rasterTime is -0.1");
    refuse(
        [&] { inputs.rasterTime = std::numeric_limits<double>::quiet_NaN(); }, "rasterTime is nan"
    );
    refuse([&] { inputs.color.image = VK_NULL_HANDLE; }, "color.image is null");
    refuse([&] { inputs.motionDepth.image = VK_NULL_HANDLE; }, "motionDepth.image is null");
    refuse(
        [&] { inputs.color.before.layout = VK_IMAGE_LAYOUT_UNDEFINED; },
        "color.before.layout is undefined"
    );
    refuse([&] { inputs.output.image = inputs.color.image; }, "leave output.image null");
    refuse(
        [&] { inputs.motionDepth.image = inputs.color.image; }, "motionDepth.image is color.image"
    );
    inputs = good;
    EXPECT_TRUE(record().ok());
}

TEST_F(EmbeddedRefusals, EachBadResponseIsNamed) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    using Points = std::vector<math::ResponsePoint>;
    const auto refuse = [&](const Points& points, const std::string& part) {
        inputs.responsePoints = points;
        expectRefusal(record(), part);
    };
    refuse({{0, 1}}, "responsePoints holds 1, it must be 2 to 64");
    refuse(Points(65), "responsePoints holds 65");
    refuse({{0.1, 1}, {1, 0}}, "responsePoints[0].time is 0.1, times must rise from 0 to 1");
    refuse({{0, 1}, {0.9, 0}}, "responsePoints[1].time is 0.9");
    refuse({{0, 1}, {0.5, 0}, {0.5, 1}, {1, 1}}, "responsePoints[2].time is 0.5");
    refuse({{0, 1}, {0.5, 0}, {0.5 + 1e-9, 1}, {1, 1}}, "responsePoints[2].time is 0.5");
    refuse({{0, 1}, {kNan, 0}, {1, 1}}, "responsePoints[1].time is nan");
    refuse({{0, 1}, {2, 0}, {1, 1}}, "responsePoints[1].time is 2");
    refuse({{0, 1}, {1, -1}}, "responsePoints[1].sensitivity is -1");
    refuse({{0, kInfinity}, {1, 1}}, "responsePoints[0].sensitivity is inf");
    refuse({{0, kNan}, {1, 1}}, "responsePoints[0].sensitivity is nan");
    refuse({{0, 0}, {1, 0}}, "no light is taken");
    const Points good{{0, 0}, {1, 1e300}};
    inputs.response = 16;
    refuse(good, "response is not 0, although there are responsePoints");
    inputs.response = 0;
    EXPECT_TRUE(record().ok());
}

TEST_F(EmbeddedRefusals, EachMethodThatCannotRunIsNamed) {
    settings.sampleCount = 257;
    expectRefusal(record(), "sampleCount");
    settings = gather();
    settings.method = &getMethod("denoised");
    expectRefusal(record(), "denoised");
    settings.method = &getMethod("hybrid");
    expectRefusal(record(), "the method hybrid needs rays");
    settings.method = &getMethod("adaptive");
    settings.raysPerPixel = 0.0f;
    expectRefusal(record(), "adaptive needs rays with times of their own");
}

TEST_F(EmbeddedRefusals, CamerasThatAMethodLacksOrThatAreNoneAreNamed) {
    settings.method = &getMethod("rosado2007");
    expectRefusal(record(), "cameras are not given, which the method rosado2007 needs");
    inputs.convention.cameras.areGiven = true;
    inputs.convention.cameras.clipFromView = glm::dmat4(0.0);
    expectRefusal(record(), "cameras.clipFromView is neither");
    settings = gather();
    expectRefusal(record(), "cameras.clipFromView"); // checkers and dumps read them
    inputs.convention.cameras.areGiven = false;
    EXPECT_TRUE(record().ok());
    settings.method = &getMethod("rosado2007");
    const glm::dmat4 clip = math::clipFromViewPerspective(1.0, 1.5, 0.1);
    inputs.convention.cameras.areGiven = true;
    inputs.convention.cameras.clipFromView = inputs.convention.cameras.clipFromViewBefore = clip;
    EXPECT_TRUE(record().ok());
    inputs.convention.scales.exposureShare = -1.0f;
    expectRefusal(record(), "exposureShare is -1");
}

TEST_F(EmbeddedRefusals, WithoutAMethodWhatDrawsInPlaceOfResolvedIsToldOnce) {
    std::string told;
    HostDevice host = describeHost();
    host.message = [&](std::string_view sentence) { told += sentence; };
    mBlur = create(host);
    settings = {};
    bool readsMotions = false;
    inputs.observe = [&](graph::Graph&, const motion_blur::MotionBlurInputs& own, const auto&) {
        readsMotions = own.instantMotions.has_value();
    };
    EXPECT_TRUE(record().ok());
    EXPECT_FALSE(readsMotions);
    EXPECT_EQ(
        told, "motion blur: keys is empty, so the default method is gather in place of resolved"
    );
    EXPECT_TRUE(record().ok());
    const motion_blur::HostCameraKey key{
        1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, 1.5, 0.1)};
    inputs.motion.keys = {&key, 1};
    EXPECT_TRUE(record().ok());
    EXPECT_TRUE(readsMotions);
    EXPECT_TRUE(told.ends_with("in place of resolved") && told.size() < 100u) << told;
}

TEST_F(EmbeddedRefusals, WhatResolvedLacksIsNamed) {
    settings.method = &getMethod("resolved");
    settings.secondRaster = true;
    const gpu::Image ids = makeImage(device(), "entity id", VK_FORMAT_R32_UINT, 40, 24);
    inputs.entityId = {ids.handle(), kSampled, kSampled};
    expectRefusal(record(), "secondRaster is true, but hosts have one raster");
    settings.secondRaster = false;
    const motion_blur::HostMover mover{0, {}};
    inputs.entityId = {};
    inputs.motion.movers = {&mover, 1};
    expectRefusal(record(), "entityId.image is null, although movers has 1 row");
    inputs.motion.movers = {};
    expectRefusal(record(), "keys holds 0"); // a still world needs no ids
    inputs.entityId = {ids.handle(), kSampled, kSampled};
    expectRefusal(record(), "keys holds 0"); // tests/unit/motion_blur has each of its fields
    inputs.motion.view = 2;
    expectRefusal(record(), "view is 2, framesInFlight 2");
    settings = gather();
    expectRefusal(record(), "view is 2, framesInFlight 2");
    inputs.motion.view = 1;
    EXPECT_TRUE(record().ok()) << "gather needs no motion";
}

TEST_F(EmbeddedRefusals, EachBadHostIsNamed) {
    const auto refuse = [](auto&& change, const std::string& part) {
        HostDevice host = describeHost();
        change(host);
        const auto made = EmbeddedMotionBlur::create(host);
        ASSERT_FALSE(made.ok()) << "expected: " << part;
        EXPECT_NE(made.error().message.find(part), std::string::npos) << made.error().message;
    };
    refuse([](HostDevice& host) { host.physical = VK_NULL_HANDLE; }, "physical is null");
    refuse([](HostDevice& host) { host.device = VK_NULL_HANDLE; }, "device is null");
    refuse([](HostDevice& host) { host.framesInFlight = 0; }, "framesInFlight is 0");
    refuse([](HostDevice& host) { host.framesInFlight = 65; }, "framesInFlight is 65");
    refuse([](HostDevice& host) { host.queueFamily = 99; }, "queueFamily 99");
    refuse([](HostDevice& host) { host.rayTier = gpu::RayTier::RayQuery; }, "sceneLayout is null");
}

TEST_F(EmbeddedRefusals, RaysWithoutTheirTablesAreNamed) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    test::SceneBuilder scene;
    render::Renderer renderer(device(), scene.world.assets);
    HostDevice host = describeHost();
    host.rayTier = device().info().rayTier;
    host.sceneLayout = renderer.scene().textureLayout();
    mBlur = create(host);
    settings.method = &getMethod("hybrid");
    expectRefusal(record(), "normal.image is null");
    inputs.normal = {mHost->output.handle(), kSampled, kSampled};
    inputs.output = {};
    expectRefusal(record(), "entityId.image is null");
    const gpu::Image entityId = makeImage(device(), "entity id", VK_FORMAT_R32_UINT, 40, 24);
    inputs.entityId = {entityId.handle(), kSampled, kSampled};
    expectRefusal(record(), "rays.frameConstants is 0");
    inputs.rays.frameConstants = 4096;
    // Nothing looks at it: it is refused for what it lacks.
    inputs.rays.tlas = reinterpret_cast<VkAccelerationStructureKHR>(uintptr_t{1});
    expectRefusal(record(), "rays.tlasBuffer is null");
}

} // namespace
} // namespace shutter
