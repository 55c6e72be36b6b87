// SPDX-License-Identifier: MIT
#include "tests/support/trapezoid.h"

#include "tests/kit/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace shutter::test {

void expectTrapezoidInEachPhase(
    gpu::Device& device, std::string_view method, uint32_t samples, double tolerance
) {
    // A white quad w pixels wide, seen over [a, a + w] at open and moved by m to the right: pixel
    // centre x is covered for the share of s in [0, 1] with a + m s <= x <= a + m s + w.
    constexpr double kWidth = 20.3;
    constexpr double kMotion = 31.7;
    SceneBuilder scene;
    scene.setPixelView(8);
    scene.add(
        makeQuad(kWidth, 20, scene.addColor({1, 1, 1})),
        {.position = {0.4, 0, -10}, .velocity = {kMotion, 0, 0}}
    );
    Stage stage(device, scene);
    for (auto phase :
         {scene::ShutterPhase::Start, scene::ShutterPhase::Centre, scene::ShutterPhase::End}) {
        const auto interval = scene::computeExposure({1.0, phase}, 0.0);
        const double left = 48.0 + 0.4 + kMotion * interval.open - kWidth / 2.0;
        const auto result =
            stage.render({.method = method, .height = 8, .phase = phase, .instants = samples});
        double highest = 0.0;
        for (uint32_t x = 0; x < 96; ++x) {
            const double enters = (x + 0.5 - left - kWidth) / kMotion;
            const double leaves = (x + 0.5 - left) / kMotion;
            const double covered = std::clamp(leaves, 0.0, 1.0) - std::clamp(enters, 0.0, 1.0);
            ASSERT_NEAR(result.color.at(x, 4, 1), covered, tolerance)
                << x << " phase " << int(phase);
            highest = std::max(highest, covered);
        }
        EXPECT_NEAR(highest, kWidth / kMotion, 1e-9) << "the trapezoid's top is in the picture";
    }
}

} // namespace shutter::test
