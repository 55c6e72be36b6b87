// SPDX-License-Identifier: MIT
// Camera motion from depth alone: right where the world is static, blind to what moves in it.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

namespace shutter {
namespace {

using math::dvec3;

class Rosado2007 : public test::GpuTest {};

/// A textured wall and a box before it, with sky at the sides.
test::SceneBuilder makeScene(const test::Placement& camera, const dvec3& boxVelocity) {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.moveCamera(camera);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(test::makeQuad(5, 3, waves), {.position = {0, 0, -5}});
    scene.add(
        test::makeBox({0.8, 0.6, 0.5}, waves), {.position = {0.2, 0, -2.5}, .velocity = boxVelocity}
    );
    return scene;
}

test::Shot shotOf(std::string_view method) {
    return {.method = method, .exposureSeconds = 0.5, .background = math::vec3(0.2f, 0.4f, 0.6f)};
}

TEST_F(Rosado2007, WhereOnlyTheCameraMovesItIsOwnVelocity) {
    const test::Placement moving{
        .velocity = {0.4, 0.1, -0.3}, .angularVelocity = {0.02, 0.1, 0.05}};
    const test::SceneBuilder scene = makeScene(moving, dvec3(0.0));
    const auto sharp = test::renderOnce(device(), scene, shotOf("sharp"));
    const auto expected = test::renderOnce(device(), scene, shotOf("own_velocity"));
    const auto result = test::renderOnce(device(), scene, shotOf("rosado2007"));
    EXPECT_LT(image::computePsnr(expected.color, sharp.color), 35.0) << "nothing was blurred";
    EXPECT_GT(image::computePsnr(result.color, expected.color), 55.0);
}

TEST_F(Rosado2007, AnObjectThatMovesBeforeAStillCameraStaysSharp) {
    const test::SceneBuilder scene = makeScene({}, {0.8, 0.2, 0.0});
    const auto sharp = test::renderOnce(device(), scene, shotOf("sharp"));
    const auto result = test::renderOnce(device(), scene, shotOf("rosado2007"));
    EXPECT_TRUE(test::sameBits(result.color, sharp.color));
}

} // namespace
} // namespace shutter
