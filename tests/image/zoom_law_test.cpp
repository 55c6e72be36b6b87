// SPDX-License-Identifier: MIT
// A lens that zooms during the exposure is motion like any other.
#include "engine/image/metrics.h"
#include "engine/scene/camera.h"
#include "engine/scene/path.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <cmath>
#include <set>

namespace shutter {
namespace {

using test::SceneBuilder;
using test::Stage;

class ZoomLaw : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

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
    scene.add(
        test::makeQuad(9, 7, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    scene.add(
        test::makeBox({0.5, 0.4, 0.4}, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0.5, 0.3, -2.5}, .angularVelocity = {0.1, 0.3, 0.2}}
    );
    return scene;
}

TEST_F(ZoomLaw, RaysAndInstantsAgree) {
    SceneBuilder scene = makeZoom();
    Stage stage(device(), scene);
    const auto draw = [&](std::string_view method) {
        return stage.render({.method = method, .width = 64, .height = 48, .instants = 256}).color;
    };
    const image::Image instants = draw("accumulate");
    EXPECT_GE(image::computePsnr(draw("truth"), instants), 45.0);
    EXPECT_LE(image::computePsnr(draw("sharp"), instants), 35.0) << "the zoom shows";
    // While the camera moves and turns, too.
    scene.moveCamera({.velocity = {0.2, 0.05, -0.3}, .angularVelocity = {0.02, 0.25, 0.1}});
    EXPECT_GE(image::computePsnr(draw("truth"), draw("accumulate")), 45.0);
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
    constexpr uint32_t kWidth = 64;
    constexpr uint32_t kHeight = 48;
    const auto drawn = stage.render(
        {.width = kWidth, .height = kHeight, .exposureSeconds = 0.5, .aovs = {"motion", "mesh_id"}}
    );
    const image::Image& motion = drawn.intermediates.at("motion");
    const auto halfExtent = [&](double seconds) {
        return std::tan(scene::yFovAt(scene.world, scene.camera, seconds) / 2.0);
    };
    // A place p from the middle is seen at p tan(raster) / tan(then).
    const double stretch = halfExtent(0.0) / halfExtent(0.25) - halfExtent(0.0) / halfExtent(-0.25);
    EXPECT_GT(stretch, 0.05);
    std::set<float> ids;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const math::dvec2 place(x + 0.5 - kWidth / 2.0, y + 0.5 - kHeight / 2.0);
            // Stored as half floats.
            const double tolerance = 1e-3 + 1e-3 * glm::length(place) * stretch;
            ASSERT_NEAR(motion.at(x, y, 0), place.x * stretch, tolerance) << x << " " << y;
            ASSERT_NEAR(motion.at(x, y, 1), place.y * stretch, tolerance) << x << " " << y;
            ids.insert(drawn.intermediates.at("mesh_id").at(x, y, 0));
        }
    EXPECT_EQ(ids.size(), 3u) << "both quads and the sky were looked at";
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

TEST_F(ZoomLaw, InsideWhatIsExcludedFromBlurThePictureIsSharp) {
    SceneBuilder scene = makeZoom();
    const ecs::Entity excluded = scene.add(
        test::makeQuad(1.2, 1.2, scene.addTextured(scene.addWaveTexture())),
        {.position = {-0.3, 0.2, -2}}
    );
    scene.world.registry.add(excluded, scene::MotionBlur{.exclude = true});
    Stage stage(device(), scene);
    const auto sharp = stage.render({.aovs = {"mesh_id"}});
    const image::Image& ids = sharp.intermediates.at("mesh_id");
    const float id = ids.at(40, 26, 0);
    const auto isInside = [&](uint32_t x, uint32_t y) {
        return x > 0 && y > 0 && x + 1 < ids.width && y + 1 < ids.height && ids.at(x, y, 0) == id &&
               ids.at(x - 1, y, 0) == id && ids.at(x + 1, y, 0) == id &&
               ids.at(x, y - 1, 0) == id && ids.at(x, y + 1, 0) == id;
    };
    const auto isElsewhere = [&](uint32_t x, uint32_t y) { return ids.at(x, y, 0) != id; };
    for (const std::string_view method : {"hybrid", "accumulate", "truth"}) {
        const auto blurred = stage.render({.method = method, .instants = 32}).color;
        EXPECT_LT(test::computeMaxDifferenceWhere(blurred, sharp.color, isInside), 4e-3) << method;
        EXPECT_GT(test::computeMaxDifferenceWhere(blurred, sharp.color, isElsewhere), 0.1)
            << method;
    }
}

} // namespace
} // namespace shutter
