// SPDX-License-Identifier: MIT
// Entity ids of a host that have no row in its table: the row is not read, and the picture stays as
// raster drew it.
#include "engine/render/renderer.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "shaders/render/scene_shared.h"
#include "tests/gpu/embedding_host.h"
#include "tests/gpu/gbuffer_host.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <array>
#include <cstring>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::MotionBlurSettings;

constexpr uint32_t kRows = 3;

/// Two movers before a wall, whose row is the last.
void build(test::SceneBuilder& scene) {
    scene.setPerspective(1.0);
    const auto waves = scene.addTextured(scene.addWaveTexture());
    scene.add(
        test::makeQuad(1.2, 1.2, waves),
        {.position = dvec3(0.2, 0.1, -3.0), .velocity = dvec3(1.0, 0.2, 0.0)}
    );
    scene.add(
        test::makeBox(dvec3(0.8), waves),
        {.position = dvec3(-0.6, -0.2, -4.0), .velocity = dvec3(-1.0, 0.0, 0.0)}
    );
    scene.add(test::makeQuad(12.0, 8.0, waves), {.position = dvec3(0.0, 0.0, -6.0)});
}

class EmbeddedIds : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (IsSkipped())
            return;
        if (!device().hasRays())
            GTEST_SKIP() << "the device traces no rays";
    }

    /// What `hybrid` draws for a host whose table ends after `rowCount` rows: what lies behind them
    /// leads nowhere.
    static image::Image draw(uint32_t rowCount, const MotionBlurSettings& settings) {
        test::SceneBuilder scene;
        build(scene);
        render::Renderer renderer(device(), scene.world.assets);
        motion_blur::HostDevice description = describeHost();
        description.rayTier = device().info().rayTier;
        description.sceneLayout = renderer.scene().textureLayout();
        const auto blur = create(description);
        test::HostOfTheGBuffer host(device(), *blur, settings, {96, 64});
        std::vector<gpu::Buffer> tables; // of the frame
        host.changeRays = [&](const render::PostContext& context, motion_blur::HostRays& rays) {
            EXPECT_EQ(context.frame.entities.size(), kRows);
            std::vector<shader::EntityRow> rows = context.frame.entities;
            for (uint32_t i = rowCount; i < rows.size(); ++i)
                std::memset(&rows[i], 0xFF, sizeof(rows[i]));
            const auto upload = [&](const void* data, size_t bytes) {
                tables.emplace_back(
                    device(),
                    "host",
                    bytes,
                    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                    gpu::MemoryUse::Stream
                );
                tables.back().writeBytes(data, bytes, 0);
                return tables.back().address();
            };
            shader::FrameConstants constants = context.frame.constants;
            constants.entities =
                gpu::splitAddress(upload(rows.data(), rows.size() * sizeof(rows[0])));
            constants.entityCount = rowCount;
            rays.frameConstants = upload(&constants, sizeof(constants));
        };
        // One of the renderer's own effects has to ask for rays.
        motion_blur::MotionBlurPlugin plugin(device(), renderer.scene(), settings);
        const std::array<render::PostEffect*, 2> effects{&host, &plugin};
        render::FrameRequest request;
        request.view.camera = scene.camera;
        scene::CameraShutter shutter;
        shutter.exposureSeconds = 0.5;
        request.view.exposure = scene::computeExposure(shutter, 0.0, scene::kStillFrameSeconds);
        request.view.width = 96;
        request.view.height = 64;
        const auto drawn = renderer.renderFrame(scene.world, request, effects);
        EXPECT_TRUE(drawn.ok());
        return host.output.read();
    }

    static MotionBlurSettings hybrid() {
        MotionBlurSettings settings;
        settings.method = &motion_blur::getMethod("hybrid");
        return settings;
    }
};

TEST_F(EmbeddedIds, WithoutRowsNothingComesIntoSight) {
    MotionBlurSettings revealsNothing = hybrid();
    revealsNothing.revealTraversal = motion_blur::RevealTraversal::Stepping;
    revealsNothing.recursionLimit = 1;
    const image::Image kept = draw(kRows, revealsNothing);
    EXPECT_FALSE(test::sameBits(draw(kRows, hybrid()), kept)) << "rays reveal something";
    EXPECT_TRUE(test::sameBits(draw(0, hybrid()), kept));
}

TEST_F(EmbeddedIds, WhatARayMeetsMayHaveNoRow) {
    // Rays behind the movers meet the wall.
    const image::Image drawn = draw(kRows - 1, hybrid());
    EXPECT_TRUE(test::allFinite(drawn));
    EXPECT_FALSE(test::sameBits(drawn, draw(kRows, hybrid())));
}

} // namespace
} // namespace shutter
