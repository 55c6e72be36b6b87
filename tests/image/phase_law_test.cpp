// SPDX-License-Identifier: MIT
// Which side of the raster picture the blur lies on.
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <cmath>

namespace shutter {
namespace {

using scene::ShutterPhase;
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

/// Least share of the true shift that a method's blur has. Those that see no background, or weigh
/// samples as if a still pixel had none, leave a part of the sharp quad where it was.
double leastShare(std::string_view method) {
    // It blurs inside the quad alone: 24 px, of which 18 px fall off linearly, have their middle at
    // (6 * 3 + 9 * 12) / 15 = 8.4 px from the end, 3.6 px from the quad's and not 9.
    if (method == "own_velocity")
        return 0.39;
    if (method == "mcguire2012" || method == "guertin2014")
        return 0.6;
    // Its 15 instants do not reach the ends of the exposure.
    if (method == "resolved" || method == "adaptive")
        return 0.93;
    return 0.94; // half a pixel
}

TEST_F(PhaseLaw, TheBlurLiesWhereTheAccumulatedPicturesDoesInEveryPhase) {
    const math::dvec2 quad(48.0, 32.0);
    for (const math::dvec3& direction :
         {math::dvec3(1, 0, 0), math::dvec3(0, -1, 0), math::dvec3(-0.6, 0.8, 0)}) {
        const SceneBuilder scene = makeScene(direction);
        Stage stage(device(), scene);
        const math::dvec2 along(direction.x, -direction.y); // pixel rows count downwards
        const math::dvec2 across(-along.y, along.x);
        for (ShutterPhase phase : {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End}) {
            const math::dvec2 truth =
                test::computeCentroid(
                    stage.render({.method = "accumulate", .phase = phase, .instants = 36}).color
                ) -
                quad;
            const double shift = expectedShift(phase) * kMotionPx;
            EXPECT_NEAR(glm::dot(truth, along), shift, 0.3);
            EXPECT_NEAR(glm::dot(truth, across), 0.0, 0.3);
            for (std::string_view method : test::listBlurMethods(device())) {
                Shot shot{.method = method, .phase = phase};
                // The paper's smears are opaque, so that their centre is the blur's.
                shot.settings = motion_blur::paperSettings();
                // The paper's magnification of the revealed layer makes the half of the blur that
                // lies inside the sharp quad too thin on purpose, which moves its centre: off here.
                shot.settings.backgroundMagnification = 1.0f;
                const math::dvec2 centroid = test::computeCentroid(stage.render(shot).color) - quad;
                const double is = glm::dot(centroid, along) * (shift < 0.0 ? -1.0 : 1.0);
                EXPECT_GE(is, leastShare(method) * std::abs(shift) - 0.1) << method << int(phase);
                EXPECT_LE(is, std::abs(shift) + 1.0) << method << int(phase);
                EXPECT_NEAR(glm::dot(centroid, across), 0.0, 0.3) << method << int(phase);
            }
        }
    }
}

} // namespace
} // namespace shutter
