// SPDX-License-Identifier: MIT
// Which side of the raster picture the blur lies on.
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

namespace shutter {
namespace {

using scene::ShutterPhase;
using test::Method;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class PhaseLaw : public test::GpuTest {};

constexpr double kMotionPx = 18.0;

/// A white quad that crosses a black picture; at time 0 its centre is the picture's.
SceneBuilder makeScene(const math::dvec3& direction) {
    SceneBuilder scene;
    scene.setPixelView(64);
    scene.add(
        test::makeQuad(24, 24, scene.addColor({1, 1, 1})),
        {.position = {0, 0, -10}, .velocity = kMotionPx * direction}
    );
    return scene;
}

/// Where the middle of the blur lies beyond the raster instant's place, in motions.
double expectedShift(ShutterPhase phase) {
    return phase == ShutterPhase::Start ? 0.5 : phase == ShutterPhase::End ? -0.5 : 0.0;
}

TEST_F(PhaseLaw, TheBlurLiesWhereTheAccumulatedPicturesDoesInEveryPhase) {
    for (const math::dvec3& direction :
         {math::dvec3(1, 0, 0), math::dvec3(0, -1, 0), math::dvec3(-0.6, 0.8, 0)}) {
        const SceneBuilder scene = makeScene(direction);
        Stage stage(device(), scene);
        for (ShutterPhase phase : {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End}) {
            const auto truth = test::computeCentroid(
                stage.render({.method = Method::Accumulate, .phase = phase, .instants = 36}).color
            );
            // Pixel rows count downwards.
            const double shift = expectedShift(phase) * kMotionPx;
            EXPECT_NEAR(truth.x, 48.0 + shift * direction.x, 0.3);
            EXPECT_NEAR(truth.y, 32.0 - shift * direction.y, 0.3);
            for (Method method : {Method::Gather, Method::Hybrid}) {
                Shot shot{.method = method, .phase = phase};
                // The paper's magnification of the revealed layer makes the half of the blur that
                // lies inside the sharp quad too thin on purpose, which moves its centre: off here.
                shot.settings.backgroundMagnification = 1.0f;
                const auto centroid = test::computeCentroid(stage.render(shot).color);
                EXPECT_NEAR(centroid.x, truth.x, 1.0) << describe(method) << int(phase);
                EXPECT_NEAR(centroid.y, truth.y, 1.0) << describe(method) << int(phase);
            }
        }
    }
}

} // namespace
} // namespace shutter
