// SPDX-License-Identifier: MIT
// A mirrored scene with mirrored motion makes the mirrored picture.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <cmath>

namespace shutter {
namespace {

using test::SceneBuilder;
using test::Shot;
using test::Stage;

class MirrorLaw : public test::GpuTest {};

constexpr uint32_t kTilePx = 16;
constexpr double kSpeedPx = 11.3;

/// Two flat rectangles before a flat wall; `side` -1 mirrors places and motion. Silhouettes lie
/// off the pixel centres, so that no tie decides what is covered.
SceneBuilder makeScene(double side) {
    SceneBuilder scene;
    scene.setPixelView(64);
    scene.add(
        test::makeQuad(70.5, 50.5, scene.addColor({0.2f, 0.6f, 0.3f})),
        {.position = {side * 4.1, 0, -20}}
    );
    scene.add(
        test::makeQuad(21.3, 30.6, scene.addColor({0.9f, 0.1f, 0.4f})),
        {.position = {side * -13.2, 3.1, -10}, .velocity = {side * kSpeedPx, 0, 0}}
    );
    return scene;
}

/// Two devices of thought, one picture: the taps of both must read the same texels. A tap lies at
/// u of the motion, (i + 1/2) / 15 + s_r - 1 (Jimenez's pairs: / 16) or (i + 1) / 16 + s_r - 1;
/// none may come so near to a border between texels that rounding decides.
void expectTapsAwayFromTexelBorders(double rasterTime) {
    for (int i = 0; i < 16; ++i)
        for (double u : {(i + 0.5) / 15.0, (i + 0.5) / 16.0, (i + 1.0) / 16.0}) {
            const double at = 0.5 + kSpeedPx * (u + rasterTime - 1.0);
            ASSERT_GT(std::abs(at - std::round(at)), 1e-3) << "tap " << i;
        }
}

TEST_F(MirrorLaw, AMirroredSceneMakesTheMirroredPicture) {
    const SceneBuilder scene = makeScene(1.0);
    const SceneBuilder mirrored = makeScene(-1.0);
    Stage stage(device(), scene);
    Stage mirroredStage(device(), mirrored);
    for (std::string_view method : test::listRasterMethods(device()))
        for (auto phase :
             {scene::ShutterPhase::Start, scene::ShutterPhase::Centre, scene::ShutterPhase::End}) {
            expectTapsAwayFromTexelBorders(scene::computeExposure({1.0, phase}, 0.0).rasterTime);
            Shot shot{.method = method, .phase = phase, .background = math::vec3(0.05f)};
            shot.settings.jitter = 0.0f;
            shot.settings.raysPerPixel = 0.0f;  // which samples get them depends on the pixel
            shot.settings.tileSizePx = kTilePx; // 96 and 64 are multiples
            const auto direct = stage.render(shot);
            const auto across = mirroredStage.render(shot);
            // The same sums in another order of taps: rounding to half floats may fall to the
            // other side, a unit in the last place of values below 1 (2^-11).
            EXPECT_LE(
                image::computeMaxDifference(direct.color, test::mirror(across.color)), 1.0 / 2048.0
            ) << method
              << int(phase);
            // And the picture is not its own mirror image, which would prove nothing.
            EXPECT_GT(image::computeMaxDifference(direct.color, across.color), 0.1);
        }
}

TEST_F(MirrorLaw, AMirroringCameraMakesTheMirroredPicture) {
    const SceneBuilder scene = makeScene(1.0);
    SceneBuilder mirroring = makeScene(1.0);
    mirroring.cameraSettings().xMag = -1.0; // its width is that of the picture
    Stage stage(device(), scene);
    Stage mirroringStage(device(), mirroring);
    for (std::string_view method : test::listRasterMethods(device())) {
        Shot shot{.method = method, .background = math::vec3(0.05f)};
        shot.settings.jitter = 0.0f;
        shot.settings.raysPerPixel = 0.0f;
        shot.settings.tileSizePx = kTilePx;
        const auto direct = stage.render(shot);
        const auto across = mirroringStage.render(shot);
        EXPECT_LE(
            image::computeMaxDifference(direct.color, test::mirror(across.color)), 1.0 / 2048.0
        ) << method;
        EXPECT_GT(image::computeMaxDifference(direct.color, across.color), 0.1);
    }
}

TEST_F(MirrorLaw, MaskAndRevealAreMirroredBitForBit) {
    Shot shot{.method = "hybrid", .aovs = {"mask", "reveal"}};
    shot.settings.tileSizePx = kTilePx;
    const auto direct = test::renderOnce(device(), makeScene(1.0), shot);
    const auto across = test::renderOnce(device(), makeScene(-1.0), shot);
    ASSERT_GT(test::countSet(direct.intermediates.at("mask")), 100u);
    for (const char* name : {"mask", "reveal"})
        EXPECT_TRUE(test::sameBits(
            direct.intermediates.at(name), test::mirror(across.intermediates.at(name))
        )) << name;
}

} // namespace
} // namespace shutter
